"""libgazebo_ros_bumper.so with SDF's <contact>; ft_sensor and f3d."""

import math

import numpy as np
import pytest
from gazebo_msgs.msg import ContactsState
from geometry_msgs.msg import WrenchStamped
from sensor_models import xyz

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist

WEIGHT = 2 * 9.8  # N, of the boxes below


def bumper(tags: str = "", contact: str = "<collision>shell</collision>", rate: float = 50) -> str:
    return f"""<model name="box"><link name="base"><inertial><mass>2</mass></inertial>
      <collision name="shell"><geometry><box><size>1 1 1</size></box></geometry></collision>
      <collision name="roof"><pose>0 0 1 0 0 0</pose>
        <geometry><box><size>0.2 0.2 1</size></box></geometry></collision>
      <sensor name="s" type="contact"><update_rate>{rate}</update_rate>
      <contact>{contact}</contact>
      <plugin name="p" filename="libgazebo_ros_bumper.so">{tags}</plugin></sensor></link></model>"""


def settled(bench, model: str, topic: str, height: float = 0.5) -> list:
    bench.spawn(model, Pose((0, 0, height)))
    bench.run(0.4)
    messages = bench.listen(topic)
    bench.run(0.1)
    return messages


def test_what_a_bumper_tells(bench):
    # conforms: libgazebo_ros_bumper.so, libgazebo_ros_bumper.so/bumperTopicName
    # conforms: libgazebo_ros_bumper.so/frameName, libgazebo_ros_bumper.so/robotNamespace
    # conforms: sdf sensor/contact/collision, sdf sensor/update_rate
    tags = """<bumperTopicName>bumped</bumperTopicName><frameName>base</frameName>
      <robotNamespace>/r1</robotNamespace>"""
    messages = settled(bench, bumper(tags), "/r1/bumped")
    assert len(messages) == 5
    last = messages[-1]
    assert isinstance(last, ContactsState)
    assert last.header.frame_id == "base"
    state, = last.states
    assert state.collision1_name == "box::base::shell"
    assert state.collision2_name == "ground_plane::link::collision"
    assert xyz(state.total_wrench.force) == pytest.approx([0, 0, WEIGHT], abs=0.3)
    assert xyz(state.total_wrench.torque) == pytest.approx([0, 0, 0], abs=0.3)
    count = len(state.contact_positions)
    assert count == len(state.contact_normals) == len(state.depths) == len(state.wrenches) >= 3
    assert sum(wrench.force.z for wrench in state.wrenches) == pytest.approx(WEIGHT, abs=0.3)
    assert xyz(state.contact_normals[0]) == pytest.approx([0, 0, 1], abs=1e-3)
    assert state.contact_positions[0].z == pytest.approx(0, abs=0.01)
    first = state.wrenches[0]
    arm = np.array(xyz(state.contact_positions[0])) - (0, 0, 0.5)
    assert xyz(first.torque) == pytest.approx(np.cross(arm, xyz(first.force)), abs=0.1)
    assert state.info.startswith("Debug:  i:(0/1)     my geom:box::base::shell   other geom:")
    assert state.info.endswith("time:0.500000000\n")


def test_a_bumper_in_the_air_sends_empty_messages(bench):
    # conforms: libgazebo_ros_bumper.so, libgazebo_ros_bumper.so/frameName
    messages = settled(bench, bumper(), "/bumper_states", height=20)
    assert [message.states for message in messages] == [[]] * 5
    assert messages[0].header.frame_id == "world"


@pytest.mark.parametrize("contact, touches", [
    ("<collision>roof</collision>", False), ("<collision>box::base::shell</collision>", True),
    ("<collision>roof</collision><collision>shell</collision>", True),
    ("<collision>__default__</collision>", True)])
def test_only_named_collisions_are_felt(bench, contact, touches):
    # conforms: sdf sensor/contact/collision
    messages = settled(bench, bumper(contact=contact), "/bumper_states")
    assert bool(messages[-1].states) is touches


def test_a_collision_that_is_not_there_is_an_error(bench, caplog):
    # conforms: sdf sensor/contact/collision
    messages = settled(bench, bumper(contact="<collision>hull</collision>"), "/bumper_states")
    assert "'hull', which is not there; there are: shell, roof" in caplog.text
    assert [message.states for message in messages] == [[]] * 5


def test_tf_prefix_of_a_bumper_is_exactly_in_its_namespace(bench):
    # conforms: tf_prefix of sensors
    bench.graph.parameters.update({"/tf_prefix": "top", "/r2/tf_prefix": "own"})
    for namespace, frame in (("r1", "world"), ("r2", "own/world")):
        tags = f"<robotNamespace>{namespace}</robotNamespace>"
        messages = settled(bench, bumper(tags), f"/{namespace}/bumper_states")
        assert messages[-1].header.frame_id == frame
        bench.delete("box")


HANGING = """<model name="crane"><static>false</static>
  <link name="beam"><inertial><mass>9</mass></inertial></link>
  <joint name="hold" type="fixed"><parent>world</parent><child>beam</child></joint>
  <link name="load"><pose>0 0 -1 {roll} 0 0</pose><inertial><mass>2</mass></inertial></link>
  <joint name="hook" type="{type}"><parent>beam</parent><child>load</child>
    <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>0</upper></limit></axis>
    <physics><ode><provide_feedback>true</provide_feedback></ode></physics></joint>
  <plugin name="p" filename="libgazebo_ros_ft_sensor.so">{tags}</plugin></model>"""
FT = "<jointName>hook</jointName><topicName>wrench</topicName>"


def crane(tags: str = FT, roll: float = 0.0, joint: str = "fixed") -> str:
    return HANGING.format(tags=tags, roll=roll, type=joint)


@pytest.mark.parametrize("joint", ["fixed", "revolute"])
def test_force_and_torque_in_a_joint(bench, joint):
    # conforms: libgazebo_ros_ft_sensor.so, libgazebo_ros_ft_sensor.so/jointName
    # conforms: libgazebo_ros_ft_sensor.so/topicName, libgazebo_ros_ft_sensor.so/robotNamespace
    tags = FT + "<robotNamespace>/r1</robotNamespace>"
    found = settled(bench, crane(tags, joint=joint), "/r1/wrench", 3)[-1]
    assert isinstance(found, WrenchStamped)
    assert found.header.frame_id == "load"
    assert xyz(found.wrench.force) == pytest.approx([0, 0, -WEIGHT], abs=0.2)


def test_a_wrench_is_in_the_childs_axes(bench):
    # conforms: libgazebo_ros_ft_sensor.so
    found = settled(bench, crane(roll=math.pi / 2), "/wrench", 3)[-1]
    assert xyz(found.wrench.force) == pytest.approx([0, -WEIGHT, 0], abs=0.2)


def test_a_wrench_at_rest_is_that_of_what_stands_still(bench):
    # conforms: libgazebo_ros_ft_sensor.so
    standing = HANGING.format(tags=FT, roll=0, type="fixed").replace("0 0 -1 0", "0 0 0.3 0")
    standing = standing.replace("<parent>world</parent><child>beam</child>",
                                "<parent>beam</parent><child>foot</child>")
    side = "<box><size>0.4 0.4 0.4</size></box>"
    bench.spawn(standing.replace("<link name=\"beam\">", f"""<link name="foot"><collision name="c">
      <geometry>{side}</geometry></collision></link><link name="beam">"""), Pose((0, 0, 0.2)))
    found = bench.listen("/wrench")
    bench.run(3.0)
    assert bench.world._client.auto_disable.disabled
    assert xyz(found[-1].wrench.force) == pytest.approx([0, 0, -WEIGHT], abs=0.02)


def test_noise_and_rate_of_a_wrench(bench):
    # conforms: libgazebo_ros_ft_sensor.so/gaussianNoise, libgazebo_ros_ft_sensor.so/updateRate
    bench.spawn(crane(FT + "<gaussianNoise>0.5</gaussianNoise><updateRate>300</updateRate>"),
                Pose((0, 0, 3)))
    bench.run(0.4)
    wrenches = bench.listen("/wrench")
    bench.run(1.0)
    assert len(wrenches) == 250
    table = np.array([xyz(w.wrench.force) + xyz(w.wrench.torque) for w in wrenches])
    assert table.std(axis=0) == pytest.approx([0.5] * 6, rel=0.2)


def test_tf_prefix_of_wrenches(bench):
    # conforms: tf_prefix of sensors
    bench.graph.parameters["/r2/tf_prefix"] = "own"
    tags = FT + "<robotNamespace>r2</robotNamespace>"
    assert settled(bench, crane(tags), "/r2/wrench", 3)[-1].header.frame_id == "own/load"
    found = settled(bench, f3d("<robotNamespace>r2</robotNamespace>"), "/r2/net", 9)
    assert found[-1].header.frame_id == "own/world"


def test_tags_that_a_force_sensor_needs(bench, caplog):
    # conforms: libgazebo_ros_ft_sensor.so/jointName, libgazebo_ros_ft_sensor.so/topicName
    for tags, said in (("<topicName>t</topicName>", "it needs a <jointName>"),
                       ("<jointName>hook</jointName>", "it needs a <topicName>"),
                       ("<jointName>x</jointName><topicName>t</topicName>", "named 'x'")):
        caplog.clear()
        bench.spawn(crane(tags))
        assert said in caplog.text
        bench.delete("crane")


def f3d(tags: str = "") -> str:
    return f"""<model name="ball"><link name="base"><inertial><mass>2</mass></inertial>
      <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>
      <plugin name="p" filename="libgazebo_ros_f3d.so"><bodyName>base</bodyName>
      <topicName>net</topicName>{tags}</plugin></model>"""


def test_net_force_is_zero_at_rest_and_the_weight_while_falling(bench):
    # conforms: libgazebo_ros_f3d.so, libgazebo_ros_f3d.so/bodyName, libgazebo_ros_f3d.so/topicName
    # conforms: libgazebo_ros_f3d.so/robotNamespace
    wrenches = settled(bench, f3d("<robotNamespace>/r1</robotNamespace>"), "/r1/net")
    assert len(wrenches) == 100
    assert wrenches[-1].header.frame_id == "world"
    assert xyz(wrenches[-1].wrench.force) == pytest.approx([0, 0, 0], abs=0.2)
    bench.world.model("ball").set_pose(Pose((0, 0, 9)))
    bench.run(0.05)
    assert xyz(wrenches[-1].wrench.force) == pytest.approx([0, 0, -WEIGHT], abs=0.1)


def test_net_torque_is_the_change_of_spin(bench):
    # conforms: libgazebo_ros_f3d.so
    model = bench.spawn(f3d(), Pose((0, 0, 9)))
    wrenches = bench.listen("/net")
    bench.run(0.01)
    model.set_twist(Twist((0, 0, 0), (0, 0, 0.5)))
    bench.run(0.001)
    inertia, step = 1.0, 0.001  # kg m^2, s: SDF's default tensor
    assert wrenches[-1].wrench.torque.z == pytest.approx(inertia * 0.5 / step, rel=1e-3)

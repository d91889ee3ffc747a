"""What the queries of /gazebo answer: every field, every text."""

import math

import pytest
import rospy

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist as Motion

INERTIA = "<inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz><ixy>0.01</ixy></inertia>"
ARM = f"""<model name="arm"><link name="base"><inertial><mass>5</mass>{INERTIA}</inertial>
    <collision name="foot"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>
  </link>
  <link name="tip"><pose>0 0 1 0 0 0</pose><gravity>false</gravity>
    <inertial><pose>0.1 0.2 0.3 0 0 1</pose><mass>2</mass>{INERTIA}</inertial></link>
  <joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child>
    <axis><xyz>0 0 1</xyz></axis></joint>
  <model name="tool"><pose>1 0 0 0 0 0</pose><link name="blade"><pose>0 0 2 0 0 0</pose>
    <collision name="edge"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
    </link><link name="grip"/>
    <joint name="screw" type="fixed"><parent>blade</parent><child>grip</child></joint></model>
</model>"""
BOX = "<model name='box'><link name='body'><gravity>false</gravity></link></model>"


def near(*values):
    return pytest.approx(values, abs=1e-6)


def xyz(message):
    return (message.x, message.y, message.z)


@pytest.fixture
def arm(bench):
    return bench.spawn(ARM)


def refused(answer, text):
    return (answer.success, answer.status_message) == (False, text)


def test_the_state_of_a_model_in_the_world(bench, caplog):
    # conforms: /gazebo/get_model_state, /gazebo/get_model_state/model_name
    # conforms: /gazebo/get_model_state/header, /gazebo/get_model_state/pose
    # conforms: /gazebo/get_model_state/twist, /gazebo/get_model_state/success
    # conforms: /gazebo/get_model_state/status_message
    box = bench.spawn(BOX, Pose.from_xyz_rpy((1, 2, 3), (0, 0, math.pi / 2)))
    box.set_twist(Motion((0.1, 0.2, 0.3), (0, 0, 0.4)))
    bench.run(0.002)
    box.set_twist(Motion((0.1, 0.2, 0.3), (0, 0, 0.4)))
    for number in (1, 2):
        answer = bench.call("/gazebo/get_model_state", model_name="box")
        assert answer.header.seq == number
    assert answer.header.stamp == rospy.Time(0, 2_000_000) and answer.header.frame_id == ""
    assert xyz(answer.pose.position) == pytest.approx((1, 2, 3), abs=1e-3)
    assert answer.pose.orientation.z == pytest.approx(math.sqrt(0.5), abs=1e-3)
    assert xyz(answer.twist.linear) == near(0.1, 0.2, 0.3)
    assert xyz(answer.twist.angular) == near(0, 0, 0.4)
    assert (answer.success, answer.status_message) == (True, "GetModelState: got properties")
    assert refused(bench.call("/gazebo/get_model_state", model_name="bo"),
                   "GetModelState: model does not exist")
    logged = [(record.levelname, record.getMessage()) for record in caplog.records]
    assert logged == [("ERROR", "GetModelState: model does not exist")]  # each time, as upstream


def test_a_state_relative_to_another_entity(bench):
    # conforms: /gazebo/get_model_state/relative_entity_name
    bench.spawn(BOX, Pose.from_xyz_rpy((1, 0, 0), (0, 0, math.pi / 2)), "a")
    moving = bench.spawn(BOX, Pose((1, 2, 0)), "b")
    moving.set_twist(Motion((1.0, 0, 0), (0, 0, 0)))
    for frame in ("a", "a::body"):
        answer = bench.call("/gazebo/get_model_state", model_name="b", relative_entity_name=frame)
        assert answer.header.frame_id == frame
        assert xyz(answer.pose.position) == near(2, 0, 0)
        assert xyz(answer.twist.linear) == near(0, -1, 0)
    for world in ("", "world", "map", "/map"):
        answer = bench.call("/gazebo/get_model_state", model_name="b", relative_entity_name=world)
        assert xyz(answer.pose.position) == near(1, 2, 0)
    bench.spawn(BOX, Pose((0, 0, 7)), "map")  # an entity of that name goes first
    answer = bench.call("/gazebo/get_model_state", model_name="b", relative_entity_name="map")
    assert answer.pose.position.z == -7
    assert refused(
        bench.call("/gazebo/get_model_state", model_name="b", relative_entity_name="/odom"),
        "GetModelState: reference relative_entity_name not found, did you forget to scope the "
        "body by model name?")


def test_a_frames_own_motion_is_subtracted_and_turned(bench):
    # conforms: /gazebo/get_model_state/twist, /gazebo/get_link_state/reference_frame
    frame = bench.spawn(BOX, Pose.from_xyz_rpy((0, 0, 0), (0, 0, math.pi / 2)), "a")
    frame.set_twist(Motion((1.0, 0, 0), (0, 0, 0.5)))
    bench.spawn(BOX, Pose((3, 0, 0)), "b")
    for answer in (
            bench.call("/gazebo/get_model_state", model_name="b", relative_entity_name="a").twist,
            bench.call("/gazebo/get_link_state", link_name="b::body",
                       reference_frame="a").link_state.twist):
        assert xyz(answer.linear) == near(0, 1, 0)  # no Coriolis term
        assert xyz(answer.angular) == near(0, 0, -0.5)


def test_the_state_of_a_link(bench, arm):
    # conforms: /gazebo/get_link_state, /gazebo/get_link_state/link_name
    # conforms: /gazebo/get_link_state/reference_frame, /gazebo/get_link_state/link_state
    # conforms: /gazebo/get_link_state/success, /gazebo/get_link_state/status_message
    arm.joint("hinge").reset(math.pi / 2, 2.0)
    for name in ("arm::tip", "tip"):
        answer = bench.call("/gazebo/get_link_state", link_name=name, reference_frame="world")
        state = answer.link_state
        assert (state.link_name, state.reference_frame) == (name, "world")
        assert xyz(state.pose.position) == near(0, 0, 1)
        assert state.pose.orientation.z == pytest.approx(math.sqrt(0.5))
        assert xyz(state.twist.angular) == near(0, 0, 2)
        assert xyz(state.twist.linear) == near(0, 0, 0)  # of the link's origin, not of its mass
    assert (answer.success, answer.status_message) == (True, "GetLinkState: got state")
    assert refused(bench.call("/gazebo/get_link_state", link_name="arm::top"),
                   "GetLinkState: link not found, did you forget to scope the link by model name?")
    assert refused(
        bench.call("/gazebo/get_link_state", link_name="arm::tip", reference_frame="odom"),
        "GetLinkState: reference reference_frame not found, did you forget to scope the link by "
        "model name?")
    assert xyz(bench.call("/gazebo/get_link_state", link_name="arm::tool::blade")
               .link_state.pose.position) == near(1, 0, 2)


def test_a_link_that_was_lumped_is_none(bench):
    # conforms: /gazebo/get_link_state/link_name, /gazebo/get_link_properties/link_name
    bench.spawn("""<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1"
      iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><link name="plate"/>
      <joint name="j" type="fixed"><parent link="base"/><child link="plate"/></joint></robot>""")
    assert not bench.call("/gazebo/get_link_state", link_name="r::plate").success
    assert not bench.call("/gazebo/get_link_properties", link_name="r::plate").success
    assert bench.call("/gazebo/get_link_state", link_name="r::base").success


def test_an_unscoped_name_has_to_be_unique(bench):
    # conforms: /gazebo/get_link_state/link_name
    bench.spawn(BOX, name="a")
    assert bench.call("/gazebo/get_link_state", link_name="body").success
    bench.spawn(BOX, name="b")
    assert not bench.call("/gazebo/get_link_state", link_name="body").success


def test_what_a_link_weighs(bench, arm):
    # conforms: /gazebo/get_link_properties, /gazebo/get_link_properties/link_name
    # conforms: /gazebo/get_link_properties/com, /gazebo/get_link_properties/gravity_mode
    # conforms: /gazebo/get_link_properties/mass, /gazebo/get_link_properties/ixx .. izz
    # conforms: /gazebo/get_link_properties/success, /gazebo/get_link_properties/status_message
    answer = bench.call("/gazebo/get_link_properties", link_name="arm::tip")
    assert xyz(answer.com.position) == near(0.1, 0.2, 0.3)
    turn = answer.com.orientation
    assert (turn.x, turn.y, turn.z, turn.w) == (0, 0, 0, 1)
    assert answer.mass == 2 and answer.gravity_mode is False
    assert (answer.ixx, answer.ixy, answer.ixz) == (0.1, 0.01, 0)
    assert (answer.iyy, answer.iyz, answer.izz) == (0.2, 0, 0.3)
    assert (answer.success, answer.status_message) == (True, "GetLinkProperties: got properties")
    assert bench.call("/gazebo/get_link_properties", link_name="arm::base").gravity_mode is True
    assert refused(
        bench.call("/gazebo/get_link_properties", link_name="arm::top"),
        "GetLinkProperties: link not found, did you forget to scope the link by model name?")


def test_where_a_joint_is(bench, arm):
    # conforms: /gazebo/get_joint_properties, /gazebo/get_joint_properties/joint_name
    # conforms: /gazebo/get_joint_properties/type, /gazebo/get_joint_properties/damping
    # conforms: /gazebo/get_joint_properties/position, /gazebo/get_joint_properties/rate
    # conforms: /gazebo/get_joint_properties/success
    # conforms: /gazebo/get_joint_properties/status_message
    arm.joint("hinge").reset(0.5, -0.25)
    bench.spawn(ARM, name="second")  # the first model that has the joint wins
    answer = bench.call("/gazebo/get_joint_properties", joint_name="hinge")
    assert (answer.type, list(answer.damping)) == (0, [])
    assert answer.position == near(0.5) and answer.rate == near(-0.25)
    assert (answer.success, answer.status_message) == (True, "GetJointProperties: got properties")
    assert bench.call("/gazebo/get_joint_properties", joint_name="root").success
    assert bench.call("/gazebo/get_joint_properties", joint_name="second::hinge").rate == near(0)
    assert refused(bench.call("/gazebo/get_joint_properties", joint_name="elbow"),
                   "GetJointProperties: joint not found")


def test_what_a_model_is_made_of(bench, arm):
    # conforms: /gazebo/get_model_properties, /gazebo/get_model_properties/model_name
    # conforms: /gazebo/get_model_properties/parent_model_name
    # conforms: /gazebo/get_model_properties/canonical_body_name
    # conforms: /gazebo/get_model_properties/body_names, /gazebo/get_model_properties/geom_names
    # conforms: /gazebo/get_model_properties/joint_names
    # conforms: /gazebo/get_model_properties/child_model_names
    # conforms: /gazebo/get_model_properties/is_static, /gazebo/get_model_properties/success
    # conforms: /gazebo/get_model_properties/status_message
    answer = bench.call("/gazebo/get_model_properties", model_name="arm")
    assert (answer.parent_model_name, answer.canonical_body_name) == ("", "")
    assert (answer.body_names, answer.geom_names) == (["base", "tip"], ["foot"])
    assert (answer.joint_names, answer.child_model_names) == (["root", "hinge"], ["tool"])
    assert (answer.success, answer.status_message) == (True, "GetModelProperties: got properties")
    assert answer.is_static is False
    assert bench.call("/gazebo/get_model_properties", model_name="ground_plane").is_static is True
    assert refused(bench.call("/gazebo/get_model_properties", model_name="leg"),
                   "GetModelProperties: model does not exist")


def test_a_model_inside_another(bench):
    # conforms: /gazebo/get_model_properties/parent_model_name, /gazebo/get_model_state/model_name
    # conforms: /gazebo/get_model_state/relative_entity_name
    arm = bench.spawn(ARM, Pose((0, 0, 5)))
    for name in ("arm::tool", "tool"):
        answer = bench.call("/gazebo/get_model_properties", model_name=name)
        assert (answer.parent_model_name, answer.body_names) == ("arm", ["blade", "grip"])
        assert (answer.geom_names, answer.joint_names) == (["edge"], ["screw"])
        assert xyz(bench.call("/gazebo/get_model_state", model_name=name)
                   .pose.position) == near(1, 0, 5)
    arm.move_link(arm.links["tool::blade"], Pose((3, 0, 9)), Motion((0, 0, 1), (0, 0, 0)))
    answer = bench.call("/gazebo/get_model_state", model_name="arm::tool",
                        relative_entity_name="arm::tool")
    assert xyz(answer.pose.position) == near(0, 0, 0)
    answer = bench.call("/gazebo/get_model_state", model_name="arm::tool")
    assert xyz(answer.pose.position) == near(3, 0, 7) and answer.twist.linear.z == 1


def test_the_world(bench):
    # conforms: /gazebo/get_world_properties, /gazebo/get_world_properties/sim_time
    # conforms: /gazebo/get_world_properties/model_names
    # conforms: /gazebo/get_world_properties/rendering_enabled
    # conforms: /gazebo/get_world_properties/success, /gazebo/get_world_properties/status_message
    bench.spawn(BOX, name="z")
    bench.spawn(BOX, name="a")
    bench.run(0.25)
    answer = bench.call("/gazebo/get_world_properties")
    assert answer.sim_time == pytest.approx(0.25)
    assert answer.model_names == ["ground_plane", "z", "a"]  # lights are no models
    assert answer.rendering_enabled is True
    assert (answer.success, answer.status_message) == (True, "GetWorldProperties: got properties")


def test_everything_is_below_the_nodes_own_name(graph, make_bench, monkeypatch):
    # conforms: /gazebo/get_world_properties
    monkeypatch.setattr(rospy.names, "_caller_id", "/left/gazebo")
    bench = make_bench()
    assert bench.call("/left/gazebo/get_world_properties").success
    assert "/left/gazebo/model_states" in bench.advertised()
    assert "/clock" in bench.advertised()
    assert not [name for name in graph.services if not name.startswith("/left/gazebo/")]

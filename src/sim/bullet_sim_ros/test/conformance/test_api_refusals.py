"""What the services refuse, in one line that says why; nothing has changed then."""

import itertools
import math

import pytest
from gazebo_msgs.msg import LinkState, ODEJointProperties
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3

from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Pose as Placement

ARM = """<model name="{name}"><link name="base"/><link name="upper"><pose>0 0 1 0 0 0</pose></link>
  <link name="hand"><pose>0 0 2 0 0 0</pose></link>
  <joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
    <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint>
  <joint name="slide" type="prismatic"><parent>upper</parent><child>hand</child>
    <axis><xyz>1 0 0</xyz></axis></joint>{more}</model>"""
BALL = "<model name='ball'><link name='l'><gravity>false</gravity></link></model>"
NO_NUMBERS = (math.nan, math.inf)
IDENTITY = {"mass": 1.0, "ixx": 1.0, "iyy": 1.0, "izz": 1.0}


def arm(name: str = "arm", more: str = "") -> str:
    return ARM.format(name=name, more=more)


def test_inertias_that_are_no_numbers(bench):
    # conforms: /gazebo/set_link_properties/ixx .. izz, /gazebo/set_link_properties/mass
    link = bench.spawn(BALL).links["l"]
    before = link.description
    for field, value in itertools.product(("mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
                                          (*NO_NUMBERS, -math.inf, 1e200)):
        answer = bench.call("/gazebo/set_link_properties", link_name="ball::l",
                            **{**IDENTITY, field: value})
        assert not answer.success, (field, value)
        assert answer.status_message.startswith(
            "SetLinkProperties: mass, ixx, iyy and izz must be")
        assert link.description is before


def test_an_inertia_that_no_body_has(bench):
    # conforms: /gazebo/set_link_properties/ixx .. izz
    # conforms: /gazebo/set_link_properties/status_message
    link = bench.spawn(BALL).links["l"]
    before = link.description
    answer = bench.call("/gazebo/set_link_properties", link_name="ball::l", ixy=2.0, **IDENTITY)
    assert not answer.success
    assert "its principal moments would be -1, 1, 3 kg m^2" in answer.status_message
    assert link.description is before
    assert bench.call("/gazebo/set_link_properties", link_name="ball::l", ixy=0.5,
                      **IDENTITY).success
    assert link.description.inertial.inertia[1] == 0.5


def test_joint_properties_that_are_no_numbers(bench):
    # conforms: /gazebo/set_joint_properties, /gazebo/set_joint_properties/status_message
    joint = bench.spawn(arm()).joint("turn")
    before = joint.description
    negative = ("erp", "cfm", "stop_erp", "stop_cfm", "fudge_factor", "fmax")
    for field, value in (*itertools.product(ODEJointProperties.__slots__, NO_NUMBERS),
                         *((field, -1.0) for field in negative)):
        config = ODEJointProperties(**{"damping": [3.0], field: [value]})
        answer = bench.call("/gazebo/set_joint_properties", joint_name="turn",
                            ode_joint_config=config)
        assert not answer.success
        assert answer.status_message.startswith(f"SetJointProperties: {field} is {value:g}")
        assert joint.description == before


def test_physics_properties_that_are_no_numbers(bench):
    # conforms: /gazebo/set_physics_properties, /gazebo/set_physics_properties/ode_config
    for field, value in itertools.product(
            ("sor_pgs_w", "cfm", "erp", "contact_surface_layer", "contact_max_correcting_vel"),
            (*NO_NUMBERS, -1.0)):
        now = bench.call("/gazebo/get_physics_properties")
        setattr(now.ode_config, field, value)
        answer = bench.call("/gazebo/set_physics_properties", time_step=0.002,
                            max_update_rate=500.0, gravity=now.gravity, ode_config=now.ode_config)
        assert not answer.success
        assert answer.status_message == (f"SetPhysicsProperties: {field} is {value:g}; it must be "
                                         "finite and not below 0")
        assert bench.world.timestep == 0.001


def test_a_model_with_more_joints_than_the_engine_takes(bench):
    # conforms: /gazebo/spawn_sdf_model, /gazebo/spawn_sdf_model/status_message
    links = "".join(f'<link name="l{n}"/><joint name="j{n}" type="revolute"><parent>hub</parent>'
                    f"<child>l{n}</child></joint>" for n in range(130))
    text = f'<sdf version="1.6"><model name="m"><link name="hub"/>{links}</model></sdf>'
    answer = bench.call("/gazebo/spawn_sdf_model", model_name="many", model_xml=text)
    assert not answer.success
    assert answer.status_message == ("model many has 130 moving joints in one piece; the engine "
                                     "takes at most 121")
    bench.run(0.2)
    assert "many" not in bench.call("/gazebo/get_world_properties").model_names


def test_a_spawn_whose_plugins_cannot_be_looked_at_leaves_nothing(bench, monkeypatch):
    # conforms: /gazebo/spawn_sdf_model/success
    def refuse(*_args):
        raise ValueError("no such thing")

    monkeypatch.setattr("bullet_sim_ros.simulation.load_plugins", refuse)
    answer = bench.call("/gazebo/spawn_sdf_model", model_name="arm",
                        model_xml=f'<sdf version="1.6">{arm()}</sdf>')
    assert (answer.success, answer.status_message) == (False, "ValueError: no such thing")
    assert "arm" not in bench.world.models
    assert len(bench.world._client.auto_disable.bodies) == 1  # the ground


def test_topics_of_a_model_that_the_engine_lost_are_closed(bench):
    # conforms: /gazebo/link_states
    plugin = """<plugin name="p" filename="libgazebo_ros_p3d.so"><bodyName>hand</bodyName>
      <topicName>truth</topicName></plugin>"""
    model = bench.spawn(arm(more=plugin))
    bench.listen("/gazebo/link_states")
    assert "/truth" in bench.advertised()
    bench.world._client.read(pybullet.removeBody, model.bodies[0].number)
    bench.run(0.2)
    assert "/truth" not in bench.advertised()
    assert "arm" not in bench.world.models
    bench.spawn(arm())  # the name is free again


def test_a_name_with_colons_in_it(bench):
    # conforms: /gazebo/get_link_state/link_name, /gazebo/get_link_state/reference_frame
    # conforms: /gazebo/set_link_state/link_state.link_name, /gazebo/apply_body_wrench/body_name
    lamp = ("<light name='lamp' type='point'/>", "a::b::base::lamp")
    outer = bench.spawn(arm("a", "").replace("<link name=\"base\"/>",
                                             f"<link name='base'>{lamp[0]}</link>"))
    inner = bench.spawn(arm("a::b").replace("<link name=\"base\"/>",
                                            f"<link name='base'>{lamp[0]}</link>"),
                        Placement((3, 0, 0)))
    answer = bench.call("/gazebo/get_link_state", link_name="a::b::hand",
                        reference_frame="a::hand")
    assert answer.success
    assert answer.link_state.pose.position.x == pytest.approx(3.0)
    assert bench.call("/gazebo/apply_body_wrench", body_name="a::b::hand").success
    assert bench.world.link("a::b::hand") is inner.links["hand"]
    assert bench.world.link("a::hand") is outer.links["hand"]
    bench.delete("a")
    assert lamp[1] in bench.world.scene.lights  # the other model's


def test_a_link_of_what_is_held_to_the_world_goes_where_its_joint_lets_it(bench):
    # conforms: /gazebo/set_link_state/link_state.pose, /gazebo/set_link_state/link_state.twist
    model = bench.spawn(arm())
    yaw = 0.4

    def put(link: str, pose: Pose, twist: Twist | None = None) -> None:
        assert bench.call("/gazebo/set_link_state", link_state=LinkState(
            link_name=f"arm::{link}", pose=pose, twist=twist or Twist())).success

    put("upper", Pose(Point(5, 5, 5), Quaternion(0, 0, math.sin(yaw / 2), math.cos(yaw / 2))),
        Twist(Vector3(), Vector3(0, 0, 0.3)))
    assert model.joint("turn").position == pytest.approx(yaw, abs=1e-6)
    assert model.joint("turn").velocity == pytest.approx(0.3, abs=1e-6)
    assert model.links["base"].pose.position == pytest.approx((0, 0, 0), abs=1e-9)
    put("hand", Pose(Point(2 * math.cos(yaw), 2 * math.sin(yaw), 7), Quaternion(0, 0, 0, 1)))
    assert model.joint("slide").position == pytest.approx(2.0, abs=1e-6)
    assert model.joint("turn").position == pytest.approx(yaw, abs=1e-6)
    put("upper", Pose(Point(), Quaternion(0, 0, math.sin(1.2), math.cos(1.2))))
    assert model.joint("turn").position == pytest.approx(1.0)  # its stop
    put("base", Pose(Point(1, 1, 1), Quaternion(0, 0, 0, 1)))
    assert model.links["base"].pose.position == pytest.approx((0, 0, 0), abs=1e-9)

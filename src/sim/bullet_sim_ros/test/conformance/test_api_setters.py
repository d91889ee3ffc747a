"""What the setters of /gazebo change, and what they say."""

import math

import pytest
from gazebo_msgs.msg import LinkState, ModelState, ODEJointProperties
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3

from bullet_sim.pose import Pose as Placement
from bullet_sim.twist import Twist as Motion

ARM = """<model name="arm"><link name="base"/><link name="tip"><gravity>false</gravity>
    <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>0.3</izz></inertia></inertial>
  </link><joint name="root" type="fixed"><parent>world</parent><child>base</child></joint>
  <joint name="hinge" type="revolute"><parent>base</parent><child>tip</child>
    <axis><xyz>0 0 1</xyz></axis></joint></model>"""
BOX = "<model name='box'><link name='body'><gravity>false</gravity></link></model>"
FREE = """<model name="pair"><link name="a"><gravity>false</gravity></link>
  <link name="b"><gravity>false</gravity><pose>1 0 0 0 0 0</pose></link></model>"""
NONE = Quaternion(0, 0, 0, 0)
LEFT = Placement.from_xyz_rpy((0, 0, 0), (0, 0, math.pi / 2))


def near(*values):
    return pytest.approx(values, abs=1e-6)


def xyz(message):
    return (message.x, message.y, message.z)


def refused(answer, text):
    return (answer.success, answer.status_message) == (False, text)


@pytest.fixture
def arm(bench):
    return bench.spawn(ARM)


def model_state(**fields):
    return {"model_state": ModelState(**fields)}


def link_state(**fields):
    return {"link_state": LinkState(**fields)}


def test_a_model_is_moved(bench):
    # conforms: /gazebo/set_model_state, /gazebo/set_model_state/model_state.model_name
    # conforms: /gazebo/set_model_state/model_state.pose, /gazebo/set_model_state/model_state.twist
    # conforms: /gazebo/set_model_state/success, /gazebo/set_model_state/status_message
    box = bench.spawn(BOX)
    answer = bench.call("/gazebo/set_model_state", **model_state(
        model_name="box", pose=Pose(Point(1, 2, 3), Quaternion(0, 0, 2, 2)),
        twist=Twist(Vector3(4, 5, 6), Vector3(0.1, 0.2, 0.3))))
    assert (answer.success, answer.status_message) == (True, "SetModelState: set model state done")
    assert box.pose.position == near(1, 2, 3)
    assert box.pose.rpy() == near(0, 0, math.pi / 2)  # the quaternion was normalised
    assert box.twist.linear == near(4, 5, 6) and box.twist.angular == near(0.1, 0.2, 0.3)
    bench.call("/gazebo/set_model_state", **model_state(
        model_name="box", pose=Pose(orientation=NONE)))
    assert box.pose.orientation == (0, 0, 0, 1)
    assert box.twist == Motion()  # a twist that is left out stops the model
    assert refused(bench.call("/gazebo/set_model_state", **model_state(model_name="fox")),
                   "SetModelState: model does not exist")


def test_a_model_is_moved_relative_to_another(bench):
    # conforms: /gazebo/set_model_state/model_state.reference_frame
    bench.spawn(BOX, Placement((5, 0, 0), LEFT.orientation), "frame")
    box = bench.spawn(BOX)
    for frame in ("frame", "frame::body"):
        bench.call("/gazebo/set_model_state", **model_state(
            model_name="box", reference_frame=frame, pose=Pose(Point(1, 0, 0), NONE),
            twist=Twist(Vector3(1, 0, 0), Vector3())))
        assert box.pose.position == near(5, 1, 0) and box.twist.linear == near(0, 1, 0)
        box.set_pose(Placement())
    for world in ("", "world", "map", "/map"):
        bench.call("/gazebo/set_model_state", **model_state(
            model_name="box", reference_frame=world, pose=Pose(Point(7, 0, 0), NONE)))
        assert box.pose.position == near(7, 0, 0)
        box.set_pose(Placement())
    assert refused(bench.call("/gazebo/set_model_state", **model_state(
        model_name="box", reference_frame="odom")),
        "SetModelState: specified reference frame entity does not exist")


def test_joints_keep_their_positions_when_a_model_is_moved(bench, arm):
    # conforms: /gazebo/set_model_state/model_state.pose
    arm.joint("hinge").reset(0.7)
    bench.call("/gazebo/set_model_state", **model_state(
        model_name="arm", pose=Pose(Point(0, 0, 1), NONE)))
    assert arm.joint("hinge").position == pytest.approx(0.7)
    assert arm.links["base"].pose.position == near(0, 0, 1)


def test_models_and_links_are_moved_by_topics(bench):
    # conforms: /gazebo/set_model_state topic, /gazebo/set_link_state topic
    box = bench.spawn(BOX)
    bench.send("/gazebo/set_model_state", ModelState(model_name="box", pose=Pose(
        Point(1, 0, 5), NONE)))
    bench.send("/gazebo/set_model_state", ModelState(model_name="fox"))  # one line in the log
    bench.run(0.001)
    assert box.pose.position == near(1, 0, 5)
    bench.send("/gazebo/set_link_state", LinkState(link_name="box::body", pose=Pose(
        Point(2, 0, 5), NONE)))
    bench.run(0.001)
    assert box.pose.position == near(2, 0, 5)


def test_a_link_is_moved(bench):
    # conforms: /gazebo/set_link_state, /gazebo/set_link_state/link_state.link_name
    # conforms: /gazebo/set_link_state/link_state.pose, /gazebo/set_link_state/link_state.twist
    # conforms: /gazebo/set_link_state/success, /gazebo/set_link_state/status_message
    pair = bench.spawn(FREE)
    answer = bench.call("/gazebo/set_link_state", **link_state(
        link_name="pair::b", pose=Pose(Point(1, 2, 3), NONE),
        twist=Twist(Vector3(1, 0, 0), Vector3(0, 0, 1))))
    assert (answer.success, answer.status_message) == (True, "SetLinkState: success")
    assert pair.links["b"].pose.position == near(1, 2, 3)
    assert pair.links["b"].twist.linear == near(1, 0, 0)
    assert pair.links["b"].twist.angular == near(0, 0, 1)
    assert pair.links["a"].pose.position == near(0, 0, 0)  # only this link
    assert refused(bench.call("/gazebo/set_link_state", **link_state(link_name="pair::c")),
                   "SetLinkState: link does not exist")


def test_a_links_frame_is_a_link_whose_velocity_is_subtracted(bench):
    # conforms: /gazebo/set_link_state/link_state.reference_frame
    frame = bench.spawn(BOX, Placement((5, 0, 0), LEFT.orientation), "frame")
    frame.set_twist(Motion((1.0, 0, 0), (0, 0, 0.5)))
    pair = bench.spawn(FREE)
    bench.call("/gazebo/set_link_state", **link_state(
        link_name="pair::b", reference_frame="frame::body", pose=Pose(Point(1, 0, 0), NONE),
        twist=Twist(Vector3(0.2, 0, 0), Vector3(0, 0, 0.2))))
    assert pair.links["b"].pose.position == near(5, 1, 0)
    assert pair.links["b"].pose.rpy() == near(0, 0, math.pi / 2)
    assert pair.links["b"].twist.linear == near(-0.8, 0, 0)
    assert pair.links["b"].twist.angular == near(0, 0, -0.3)
    for bad in ("frame", "odom"):
        assert refused(bench.call("/gazebo/set_link_state", **link_state(
            link_name="pair::b", reference_frame=bad)), "SetLinkState: failed")


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e200])
def test_numbers_that_are_none_are_refused_in_one_line(bench, arm, value):
    # conforms: /gazebo/set_model_state/model_state.pose, /gazebo/set_link_state/link_state.pose
    # conforms: /gazebo/set_model_configuration/joint_positions
    # conforms: /gazebo/set_link_properties/mass
    pose = Pose(Point(value, 0, 0), NONE)
    config = ODEJointProperties(vel=[value])
    for answer in (
            bench.call("/gazebo/set_model_state", **model_state(model_name="arm", pose=pose)),
            bench.call("/gazebo/set_link_state", **link_state(link_name="arm::tip", pose=pose)),
            bench.call("/gazebo/set_model_configuration", model_name="arm", joint_names=["hinge"],
                       joint_positions=[value]),
            bench.call("/gazebo/set_joint_properties", joint_name="hinge",
                       ode_joint_config=config),
            bench.call("/gazebo/set_link_properties", link_name="arm::tip", mass=value, ixx=1.0,
                       iyy=1.0, izz=1.0)):
        assert not answer.success and "finite" in answer.status_message
    assert arm.joint("hinge").position == 0.0


def test_joints_are_put_at_positions(bench, arm):
    # conforms: /gazebo/set_model_configuration, /gazebo/set_model_configuration/model_name
    # conforms: /gazebo/set_model_configuration/urdf_param_name
    # conforms: /gazebo/set_model_configuration/joint_names
    # conforms: /gazebo/set_model_configuration/joint_positions
    # conforms: /gazebo/set_model_configuration/success
    # conforms: /gazebo/set_model_configuration/status_message
    answer = bench.call("/gazebo/set_model_configuration", model_name="arm",
                        urdf_param_name="robot_description", joint_names=["elbow", "hinge"],
                        joint_positions=[1.0, 0.5])
    assert (answer.success, answer.status_message) == (True, "SetModelConfiguration: success")
    assert arm.joint("hinge").position == pytest.approx(0.5)
    assert refused(bench.call("/gazebo/set_model_configuration", model_name="leg"),
                   "SetModelConfiguration: model does not exist")
    assert refused(
        bench.call("/gazebo/set_model_configuration", model_name="arm", joint_names=["hinge"]),
        "SetModelConfiguration: joint name and position list have different lengths")


def joint_properties(bench, **arrays):
    answer = bench.call("/gazebo/set_joint_properties", joint_name="hinge",
                        ode_joint_config=ODEJointProperties(**arrays))
    assert (answer.success, answer.status_message) == (True, "SetJointProperties: properties set")


def test_stops_of_a_joint(bench, arm):
    # conforms: /gazebo/set_joint_properties, /gazebo/set_joint_properties/joint_name
    # conforms: /gazebo/set_joint_properties/hiStop, /gazebo/set_joint_properties/loStop
    # conforms: /gazebo/set_joint_properties/success
    # conforms: /gazebo/set_joint_properties/status_message
    joint = arm.joint("hinge")
    joint_properties(bench, hiStop=[0.5], loStop=[-0.25])
    joint.reset(0.0, 2.0)
    bench.run(0.5)
    assert joint.position == pytest.approx(0.5, abs=0.02)
    joint_properties(bench, hiStop=[1.0])
    joint.reset(0.0, -2.0)
    bench.run(0.5)
    assert joint.position == pytest.approx(-0.25, abs=0.02)  # the other one was left alone
    assert refused(bench.call("/gazebo/set_joint_properties", joint_name="elbow"),
                   "SetJointProperties: joint not found")


def test_damping_of_a_joint(bench, arm):
    # conforms: /gazebo/set_joint_properties/damping
    joint = arm.joint("hinge")
    joint.reset(0.0, 1.0)
    joint_properties(bench, damping=[0.6])
    bench.run(3.0)
    assert joint.position == pytest.approx(0.3 / 0.6, rel=0.02)  # inertia x rate / damping


def test_the_motor_of_a_joint(bench, arm):
    # conforms: /gazebo/set_joint_properties/fmax, /gazebo/set_joint_properties/vel
    joint = arm.joint("hinge")
    joint_properties(bench, fmax=[0.6], vel=[1.0])
    bench.run(0.1)
    assert joint.velocity == pytest.approx(0.6 * 0.1 / 0.3, rel=0.02)
    bench.run(1.0)
    assert joint.velocity == pytest.approx(1.0, rel=1e-3)
    joint_properties(bench, vel=[0.5])
    bench.run(1.0)
    assert joint.velocity == pytest.approx(0.5, rel=1e-3)


def test_what_the_engine_has_no_use_for_is_accepted(bench, arm):
    # conforms: /gazebo/set_joint_properties
    joint_properties(bench, erp=[0.1], cfm=[0.1], stop_erp=[0.1], stop_cfm=[0.1],
                     fudge_factor=[0.1])


def test_what_a_link_weighs_can_be_changed(bench):
    # conforms: /gazebo/set_link_properties, /gazebo/set_link_properties/link_name
    # conforms: /gazebo/set_link_properties/com, /gazebo/set_link_properties/gravity_mode
    # conforms: /gazebo/set_link_properties/mass, /gazebo/set_link_properties/ixx .. izz
    # conforms: /gazebo/set_link_properties/success, /gazebo/set_link_properties/status_message
    box = bench.spawn(BOX, Placement((0, 0, 10)))
    values = dict(mass=4.0, ixx=0.3, ixy=0.01, ixz=0.0, iyy=0.4, iyz=0.0, izz=0.5)
    answer = bench.call("/gazebo/set_link_properties", link_name="box::body", gravity_mode=True,
                        com=Pose(Point(0.5, 0, 0), NONE), **values)
    assert (answer.success, answer.status_message) == (True, "SetLinkProperties: properties set")
    told = bench.call("/gazebo/get_link_properties", link_name="box::body")
    assert {name: getattr(told, name) for name in values} == values
    assert told.com.position.x == 0.5 and told.gravity_mode is True
    bench.run(0.1)
    assert box.twist.linear[2] == pytest.approx(-0.98, rel=0.02)  # it falls now
    turning = bench.spawn(BOX, name="free")
    bench.call("/gazebo/set_link_properties", link_name="free::body",
               com=Pose(Point(0.5, 0, 0), NONE), **values)
    turning.bodies[0].links.apply_force("body", (4.0, 0, 0), (0, 0, 0.5))
    bench.run(0.001)
    assert turning.twist.angular[2] == pytest.approx(0.001, rel=1e-3)  # torque / izz
    assert turning.twist.linear[:2] == pytest.approx((0.001, -0.0005), rel=1e-3)  # about the com
    assert refused(
        bench.call("/gazebo/set_link_properties", link_name="body::box"),
        "SetLinkProperties: link not found, did you forget to scope the link by model name?")
    assert "get_link_properties" in bench.call(
        "/gazebo/set_link_properties", link_name="box::body").status_message

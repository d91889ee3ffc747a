"""Skid steering, planar moves and tricycles: commands, odometry, transforms."""

import math

import pytest
import rospy

from bullet_sim.pose import Pose, quaternion_from_rpy

SKID = "libgazebo_ros_skid_steer_drive.so"
PLANAR = "libgazebo_ros_planar_move.so"
TRICYCLE = "libgazebo_ros_tricycle_drive.so"
UNKNOWN = 1e12


def yaw(pose) -> float:
    return 2 * math.atan2(pose.orientation.z, pose.orientation.w)


def transforms(messages) -> dict:
    return {t.child_frame_id: t for message in messages for t in message.transforms}


# --- skid steering

SKID_TAGS = {"leftFrontJoint": "left_front_joint", "rightFrontJoint": "right_front_joint",
             "leftRearJoint": "left_rear_joint", "rightRearJoint": "right_rear_joint",
             "wheelSeparation": 0.4, "wheelDiameter": 0.2}


@pytest.fixture
def skid(robots):
    """`skid(tag=value)`: four driven wheels."""
    def make(**tags) -> str:
        return robots.four_wheels(robots.plugin(SKID, **{**SKID_TAGS, **tags}))
    return make


def test_skid_steering_turns_both_wheels_of_a_side_alike(bench, skid, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so
    # conforms: libgazebo_ros_skid_steer_drive.so/wheelSeparation
    # conforms: libgazebo_ros_skid_steer_drive.so/wheelDiameter
    car = bench.spawn(skid(torque=20, wheelSeparation=0.6))  # wider than it is, to see the tag
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", robots.command(0.4, turn=0.5))
    bench.run(1.5)
    rates = {name: joint.velocity for name, joint in car.joints.items()}
    for place in ("front", "rear"):
        assert rates[f"left_{place}_joint"] == pytest.approx(2.5, abs=0.1)
        assert rates[f"right_{place}_joint"] == pytest.approx(5.5, abs=0.1)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.4, abs=0.05)
    assert 0.05 < odometry[-1].twist.twist.angular.z < 0.5  # it slips


@pytest.mark.parametrize("side, place", [("left", "Front"), ("right", "Front"), ("left", "Rear"),
                                         ("right", "Rear")])
def test_skid_steering_needs_all_four_joints(bench, skid, caplog, side, place):
    # conforms: libgazebo_ros_skid_steer_drive.so/leftFrontJoint
    # conforms: libgazebo_ros_skid_steer_drive.so/rightFrontJoint
    # conforms: libgazebo_ros_skid_steer_drive.so/leftRearJoint
    # conforms: libgazebo_ros_skid_steer_drive.so/rightRearJoint
    bench.spawn(skid(**{f"{side}{place}Joint": "nope"}))
    assert "is not loaded: no joint of model car named 'nope'" in caplog.text
    assert "/cmd_vel" not in bench.subscribed()


def test_skid_steering_defaults(bench, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so/updateRate
    car = bench.spawn(robots.four_wheels(robots.plugin(SKID)))  # namespace: the root
    odometry, tf = bench.listen("/odom"), bench.listen("/tf")
    bench.send("/cmd_vel", robots.command(0.3))
    bench.run(1.0)
    assert len(odometry) == 100
    assert not tf  # broadcastTF is off
    last = odometry[-1]
    assert (last.header.frame_id, last.child_frame_id) == ("odom", "base_footprint")
    assert list(last.pose.covariance[::7]) == [1e-4, 1e-4, UNKNOWN, UNKNOWN, UNKNOWN, 1e-2]
    assert last.twist.covariance == last.pose.covariance
    assert car.joints["left_rear_joint"].velocity == pytest.approx(0.3 / 0.075, rel=0.03)


def test_skid_steering_tags(bench, skid, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so/robotNamespace
    # conforms: libgazebo_ros_skid_steer_drive.so/broadcastTF
    # conforms: libgazebo_ros_skid_steer_drive.so/odometryFrame
    # conforms: libgazebo_ros_skid_steer_drive.so/robotBaseFrame
    # conforms: libgazebo_ros_skid_steer_drive.so/covariance_x
    # conforms: libgazebo_ros_skid_steer_drive.so/covariance_y
    # conforms: libgazebo_ros_skid_steer_drive.so/covariance_yaw
    # conforms: libgazebo_ros_skid_steer_drive.so/commandTopic
    # conforms: libgazebo_ros_skid_steer_drive.so/odometryTopic
    # conforms: libgazebo_ros_skid_steer_drive.so/updateRate
    bench.graph.parameters["/tf_prefix"] = "r1"
    car = bench.spawn(skid(robotNamespace="/ns", broadcastTF="true", odometryFrame="o",
                           robotBaseFrame="b", covariance_x=1, covariance_y=2, covariance_yaw=3,
                           commandTopic="go", odometryTopic="way", updateRate=20),
                      Pose((1.0, 2.0, 0.5)))
    odometry, tf = bench.listen("/ns/way"), bench.listen("/tf")
    bench.send("/ns/go", robots.command(0.2))
    bench.run(1.0)
    assert len(odometry) == 20
    assert odometry[0].header.stamp == rospy.Time(0, 50_000_000)
    assert list(odometry[0].pose.covariance[::7]) == [1, 2, UNKNOWN, UNKNOWN, UNKNOWN, 3]
    pose, moved = odometry[0].pose.pose, transforms(tf[:1])["r1/b"]
    assert (pose.position.x, pose.position.y) == pytest.approx((1.0, 2.0), abs=0.05)
    assert pose.position.z == 0.0  # flat, but for the transform
    assert moved.header.frame_id == "r1/o"
    assert moved.transform.translation.z == pytest.approx(0.5, abs=0.05)
    assert car.twist.linear[0] == pytest.approx(0.2, abs=0.02)


def test_skid_steering_torque_is_the_most_a_wheel_can_do(bench, skid, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so/torque
    car = bench.spawn(skid(torque=0.01))
    bench.send("/cmd_vel", robots.command(1.0))
    bench.run(0.5)
    # four motors push 9 kg and wheels of 0.01 kg m^2 with 0.4 N at the rim
    assert 0.0 < car.twist.linear[0] < 0.04


def test_skid_steering_with_negative_sizes_reverses_as_upstream(bench, skid, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so/wheelSeparation
    # conforms: libgazebo_ros_skid_steer_drive.so/wheelDiameter
    car = bench.spawn(skid(wheelDiameter=-0.2, wheelSeparation=-0.4, torque=20))
    bench.send("/cmd_vel", robots.command(0.3, turn=0.5))
    bench.run(0.5)
    assert car.joints["left_front_joint"].velocity == pytest.approx(-4.0, rel=0.05)
    assert car.joints["right_rear_joint"].velocity == pytest.approx(-2.0, rel=0.05)


def test_skid_steering_stops_at_a_reset(bench, skid, robots):
    # conforms: libgazebo_ros_skid_steer_drive.so
    car = bench.spawn(skid())
    bench.send("/cmd_vel", robots.command(0.3))
    bench.run(0.5)
    bench.call("/gazebo/reset_simulation")
    bench.run(0.5)
    assert abs(car.pose.position[0]) < 0.02


# --- planar moves

@pytest.fixture
def planar(robots):
    """`planar(tag=value)`: a smooth cube."""
    def make(**tags) -> str:
        return robots.cube("cube", robots.plugin(PLANAR, **tags))
    return make


def test_a_planar_move_goes_anywhere_in_its_own_heading(bench, planar, robots):
    # conforms: libgazebo_ros_planar_move.so
    cube = bench.spawn(planar(), Pose((0, 0, 0.1), quaternion_from_rpy(0, 0, math.pi / 2)))
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", robots.command(0.3, 0.2, 0.0))
    bench.run(1.0)
    x, y, _ = cube.pose.position
    assert (x, y) == pytest.approx((-0.2, 0.3), abs=0.01)
    twist = odometry[-1].twist.twist
    assert (twist.linear.x, twist.linear.y) == pytest.approx((0.3, 0.2), abs=0.01)
    bench.send("/cmd_vel", robots.command(turn=1.0))
    bench.run(1.0)
    assert odometry[-1].twist.twist.angular.z == pytest.approx(1.0, abs=0.02)
    assert cube.pose.rpy()[2] == pytest.approx(math.pi / 2 + 1.0, abs=0.02)


def test_a_planar_move_has_no_upward_velocity_so_gravity_hardly_counts(bench, planar):
    # conforms: libgazebo_ros_planar_move.so
    cube = bench.spawn(planar(), Pose((0, 0, 2.0)))
    bench.run(1.0)
    assert cube.pose.position[2] == pytest.approx(2.0, abs=0.02)  # g dt^2 a step: 1 cm/s


def test_wheels_of_a_planar_move_go_on_turning(bench, robots):
    # conforms: libgazebo_ros_planar_move.so
    car = bench.spawn(robots.four_wheels(robots.plugin(PLANAR)), Pose((0, 0, 1.0)))
    car.joints["left_rear_joint"].reset(0.0, 5.0)
    bench.run(0.2)
    assert car.joints["left_rear_joint"].velocity == pytest.approx(5.0, abs=0.1)


def test_odometry_of_a_planar_move(bench, planar):
    # conforms: libgazebo_ros_planar_move.so/odometryRate
    cube = bench.spawn(planar(), Pose((1.0, 0, 0.5)))
    odometry, tf = bench.listen("/odom"), bench.listen("/tf")
    bench.run(1.0)
    # 20 Hz, but more than a period has to go by each time: 51 ms
    assert [msg.header.stamp.to_nsec() // 10**6 for msg in odometry[:3]] == [51, 102, 153]
    assert list(odometry[0].pose.covariance[::7]) == [1e-5, 1e-5, UNKNOWN, UNKNOWN, UNKNOWN, 1e-3]
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("odom", "base_footprint")
    assert odometry[0].pose.pose.position.z == 0.0
    assert len(tf) == len(odometry)
    assert transforms(tf[-1:])["base_footprint"].transform.translation.z == pytest.approx(
        cube.pose.position[2], abs=1e-3)


def test_planar_move_tags(bench, planar, robots):
    # conforms: libgazebo_ros_planar_move.so/robotNamespace
    # conforms: libgazebo_ros_planar_move.so/commandTopic
    # conforms: libgazebo_ros_planar_move.so/odometryTopic
    # conforms: libgazebo_ros_planar_move.so/odometryFrame
    # conforms: libgazebo_ros_planar_move.so/robotBaseFrame
    # conforms: libgazebo_ros_planar_move.so/odometryRate
    bench.graph.parameters["/ns/tf_prefix"] = "r1"
    cube = bench.spawn(planar(robotNamespace="ns", commandTopic="go", odometryTopic="way",
                              odometryFrame="o", robotBaseFrame="/b", odometryRate=0),
                       Pose((0, 0, 0.1)))
    odometry = bench.listen("/ns/way")
    bench.send("/ns/go", robots.command(0.5))
    bench.run(0.5)
    assert not odometry  # a rate of 0 is none
    assert cube.twist.linear[0] == pytest.approx(0.5, abs=0.02)
    bench.delete("cube")
    bench.spawn(planar(robotNamespace="ns", odometryFrame="o", robotBaseFrame="/b",
                       odometryTopic="way", odometryRate=100))
    odometry = bench.listen("/ns/way")
    bench.run(0.11)
    assert len(odometry) == 10
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("r1/o", "b")


@pytest.mark.parametrize("timeout, moved", [(None, 0.5), (-1, 0.5), (0.2, 0.1)])
def test_a_planar_move_may_grow_old(bench, planar, robots, timeout, moved):
    # conforms: libgazebo_ros_planar_move.so/cmdTimeout
    cube = bench.spawn(planar(**({} if timeout is None else {"cmdTimeout": timeout})),
                       Pose((0, 0, 0.1)))
    bench.send("/cmd_vel", robots.command(0.5))
    bench.run(1.0)
    assert cube.pose.position[0] == pytest.approx(moved, abs=0.01)


# --- tricycles

@pytest.fixture
def tricycle(robots):
    """`tricycle(tag=value)`: steered and driven in front."""
    def make(**tags) -> str:
        return robots.three_wheels(robots.plugin(TRICYCLE, **{
            "robotNamespace": "/", "actuatedWheelDiameter": 0.2, "encoderWheelDiameter": 0.2,
            "encoderWheelSeparation": 0.4, **tags}))
    return make


def test_a_tricycle_drives_a_curve_by_its_steering_angle(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so
    # conforms: libgazebo_ros_tricycle_drive.so/actuatedWheelDiameter
    # conforms: libgazebo_ros_tricycle_drive.so/robotNamespace
    car = bench.spawn(tricycle(wheelTorque=10))
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", robots.command(0.3, turn=0.4))
    bench.run(3.0)
    assert car.joints["front_steering_joint"].position == pytest.approx(0.4, abs=0.01)
    assert car.joints["front_wheel_joint"].velocity == pytest.approx(3.0, rel=0.02)
    # the rear axle turns at v sin(angle) / wheelbase
    turn = 0.3 * math.sin(0.4) / 0.5
    assert odometry[-1].twist.twist.angular.z == pytest.approx(turn, rel=0.1)
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("odom", "base_link")
    assert len(odometry) == 300


@pytest.mark.parametrize("tag", ["steeringJoint", "actuatedWheelJoint", "encoderWheelLeftJoint",
                                 "encoderWheelRightJoint"])
def test_a_tricycle_needs_its_joints(bench, tricycle, caplog, tag):
    # conforms: libgazebo_ros_tricycle_drive.so/steeringJoint
    # conforms: libgazebo_ros_tricycle_drive.so/actuatedWheelJoint
    # conforms: libgazebo_ros_tricycle_drive.so/encoderWheelLeftJoint
    # conforms: libgazebo_ros_tricycle_drive.so/encoderWheelRightJoint
    bench.spawn(tricycle(**{tag: "nope"}))
    assert "is not loaded: no joint of model car named 'nope'" in caplog.text


def test_steering_is_bounded_and_may_take_its_time(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so/steeringSpeed
    # conforms: libgazebo_ros_tricycle_drive.so/steeringAngleTolerance
    car = bench.spawn(tricycle())
    steering = car.joints["front_steering_joint"]
    bench.send("/cmd_vel", robots.command(0.0, turn=3.0))
    bench.run(0.05)
    assert steering.position == pytest.approx(math.pi / 2, abs=0.01)
    bench.delete("car")
    car = bench.spawn(tricycle(steeringSpeed=0.5, steeringAngleTolerance=0.05))
    steering = car.joints["front_steering_joint"]
    bench.send("/cmd_vel", robots.command(0.0, turn=0.4))
    bench.run(0.4)
    assert steering.position == pytest.approx(0.2, abs=0.02)
    bench.run(1.0)
    assert 0.34 < steering.position < 0.38  # it stops where it is near enough


def test_the_driven_wheel_speeds_up_and_slows_down_at_rates(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so/wheelAcceleration
    # conforms: libgazebo_ros_tricycle_drive.so/wheelDeceleration
    # conforms: libgazebo_ros_tricycle_drive.so/wheelSpeedTolerance
    car = bench.spawn(tricycle(wheelAcceleration=2, wheelDeceleration=8, wheelTorque=10,
                               wheelSpeedTolerance=1.0))
    wheel = car.joints["front_wheel_joint"]
    bench.send("/cmd_vel", robots.command(0.4))  # 4 rad/s
    bench.run(1.0)
    assert wheel.velocity == pytest.approx(2.0, abs=0.1)
    bench.run(0.55)
    assert wheel.velocity == pytest.approx(4.0, abs=0.1)  # within the tolerance: at once
    bench.send("/cmd_vel", robots.command(0.0))
    bench.run(0.25)
    assert wheel.velocity == pytest.approx(2.0, abs=0.1)


def test_wheel_torque(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so/wheelTorque
    car = bench.spawn(tricycle(wheelTorque=0.02))
    bench.send("/cmd_vel", robots.command(1.0))
    bench.run(0.5)
    assert 0.0 < car.twist.linear[0] < 0.1


def test_encoders_of_a_tricycle_start_at_zero_and_keep_the_sign(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so/odometrySource
    # conforms: libgazebo_ros_tricycle_drive.so/encoderWheelDiameter
    # conforms: libgazebo_ros_tricycle_drive.so/encoderWheelSeparation
    car = bench.spawn(tricycle(odometrySource="encoder"), Pose((3.0, 0.0, 0.0)))
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", robots.command(-0.3, turn=0.3))
    bench.run(1.5)
    pose, twist = odometry[-1].pose.pose, odometry[-1].twist.twist
    assert pose.position.x == pytest.approx(car.pose.position[0] - 3.0, abs=0.06)
    assert pose.position.x < -0.2
    assert yaw(pose) == pytest.approx(car.pose.rpy()[2], abs=0.03)
    assert twist.linear.x < -0.2
    bench.call("/gazebo/reset_simulation")
    odometry.clear()
    bench.run(0.5)
    assert abs(odometry[-1].pose.pose.position.x) < 0.02


def test_joint_states_and_wheel_transforms_of_a_tricycle(bench, tricycle, robots):
    # conforms: libgazebo_ros_tricycle_drive.so/publishWheelJointState
    # conforms: libgazebo_ros_tricycle_drive.so/publishWheelTF
    joints = ["front_steering_joint", "front_wheel_joint", "left_wheel_joint", "right_wheel_joint"]
    bench.spawn(tricycle(publishWheelJointState="true", publishWheelTF="true", wheelTorque=7))
    states, tf = bench.listen("/joint_states"), bench.listen("/tf")
    bench.send("/cmd_vel", robots.command(0.2))
    bench.run(0.5)
    assert states[-1].name == joints
    assert states[-1].effort == [7.0, 7.0, 0.0, 0.0]
    assert states[-1].velocity[1] == pytest.approx(2.0, abs=0.1)
    assert {"base_link", *joints} == set(transforms(tf))
    assert transforms(tf)["left_wheel_joint"].header.frame_id == "base"
    bench.delete("car")
    bench.spawn(tricycle())
    tf = bench.listen("/tf")
    bench.run(0.1)
    assert set(transforms(tf)) == {"base_link"}
    assert "/joint_states" not in bench.advertised()


def test_tricycle_names(bench, tricycle, robots, caplog):
    # conforms: libgazebo_ros_tricycle_drive.so/commandTopic
    # conforms: libgazebo_ros_tricycle_drive.so/odometryTopic
    # conforms: libgazebo_ros_tricycle_drive.so/odometryFrame
    # conforms: libgazebo_ros_tricycle_drive.so/robotBaseFrame
    # conforms: libgazebo_ros_tricycle_drive.so/updateRate
    car = bench.spawn(tricycle(robotNamespace="", commandTopic="go", odometryTopic="way",
                               odometryFrame="o", robotBaseFrame="b", updateRate=10))
    odometry = bench.listen("/car/way")  # an empty namespace is the model's name
    bench.send("/car/go", robots.command(0.2))
    bench.run(1.0)
    assert len(odometry) == 10
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("o", "b")
    assert car.twist.linear[0] == pytest.approx(0.2, abs=0.03)
    assert "TricycleDrive(ns = car/): missing <wheelTorque> default is 5" in caplog.text

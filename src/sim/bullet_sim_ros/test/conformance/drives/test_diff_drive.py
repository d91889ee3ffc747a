"""libgazebo_ros_diff_drive.so: commands, odometry, transforms, joint states."""

import logging

import pytest
import rospy

from bullet_sim.pose import Pose

LIBRARY = "libgazebo_ros_diff_drive.so"
TAGS = {"robotNamespace": "/", "leftJoint": "left_joint", "rightJoint": "right_joint",
        "wheelSeparation": 0.4, "wheelDiameter": 0.2, "publishTf": "true"}


@pytest.fixture
def robot(robots):
    """`robot(tag=value)`: a car whose plugin has these tags; None leaves one out."""
    def make(name: str = "car", **tags) -> str:
        chosen = {tag: value for tag, value in {**TAGS, **tags}.items() if value is not None}
        return robots.two_wheels(robots.plugin(LIBRARY, **chosen), name=name)
    return make


@pytest.fixture
def command(robots):
    """A message."""
    return lambda forward, turn=0.0: robots.command(forward, 0.0, turn)


def transforms(messages) -> dict:
    return {t.child_frame_id: t for message in messages for t in message.transforms}


def test_it_drives_as_told_for_ever_and_tells_where_the_model_is(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so, libgazebo_ros_diff_drive.so/robotNamespace
    # conforms: libgazebo_ros_diff_drive.so/wheelSeparation
    # conforms: libgazebo_ros_diff_drive.so/wheelDiameter
    car = bench.spawn(robot())
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", command(0.3, 0.5))
    bench.run(2.0)  # no time-out
    twist, pose = odometry[-1].twist.twist, odometry[-1].pose.pose
    assert twist.linear.x == pytest.approx(0.3, rel=0.02)
    assert twist.angular.z == pytest.approx(0.5, rel=0.03)
    assert pose.position.x == pytest.approx(car.pose.position[0], abs=1e-3)
    assert pose.position.y == pytest.approx(car.pose.position[1], abs=1e-3)
    left, right = car.joints["left_joint"].velocity, car.joints["right_joint"].velocity
    assert left == pytest.approx((0.3 - 0.5 * 0.2) / 0.1, rel=0.02)
    assert right == pytest.approx((0.3 + 0.5 * 0.2) / 0.1, rel=0.02)


def test_a_command_grows_old_where_it_is_asked_to(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/commandTimeout
    car = bench.spawn(robot(commandTimeout=0.4))
    bench.send("/cmd_vel", command(0.3))
    bench.run(0.39)
    assert car.joints["left_joint"].velocity == pytest.approx(3.0, rel=0.02)
    bench.run(0.2)
    assert car.joints["left_joint"].velocity == pytest.approx(0.0, abs=0.02)
    bench.send("/cmd_vel", command(0.3))
    bench.run(0.2)
    assert car.joints["left_joint"].velocity == pytest.approx(3.0, rel=0.02)


def test_frames_rate_stamps_and_covariances(bench, robot):
    # conforms: libgazebo_ros_diff_drive.so/updateRate, libgazebo_ros_diff_drive.so/odometryFrame
    # conforms: libgazebo_ros_diff_drive.so/robotBaseFrame
    # conforms: libgazebo_ros_diff_drive.so/odometryTopic
    bench.graph.parameters["/r1/tf_prefix"] = "pre"
    bench.spawn(robot(robotNamespace="/r1/deep", updateRate=30, odometryFrame="start",
                      robotBaseFrame="foot", odometryTopic="way"))
    odometry = bench.listen("/r1/deep/way")
    bench.run(1.0)
    assert len(odometry) == 30
    assert odometry[0].header.stamp == rospy.Time(0, 34_000_000)
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("pre/start", "pre/foot")
    assert list(odometry[0].pose.covariance[::7]) == [1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3]
    assert not any(odometry[0].twist.covariance)


def test_defaults_are_upstreams(bench, robot):
    # conforms: libgazebo_ros_diff_drive.so/odometryTopic
    # conforms: libgazebo_ros_diff_drive.so/updateRate
    bench.spawn(robot("alone", **dict.fromkeys(TAGS)))
    assert "/alone/cmd_vel" in bench.subscribed()  # a missing namespace is the model's name
    odometry = bench.listen("/alone/odom")
    bench.run(0.5)
    assert len(odometry) == 50
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("odom", "base_footprint")
    assert "/alone/joint_states" not in bench.advertised()


def test_command_topic(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/commandTopic
    car = bench.spawn(robot(commandTopic="/global/go"))
    bench.send("/global/go", command(0.2))
    bench.run(0.5)
    assert car.twist.linear[0] == pytest.approx(0.2, rel=0.03)


def test_a_command_that_is_no_number_is_ignored(bench, robot, command, caplog):
    # conforms: libgazebo_ros_diff_drive.so/commandTopic
    car = bench.spawn(robot())
    bench.send("/cmd_vel", command(float("nan")))
    bench.run(0.2)
    assert abs(car.twist.linear[0]) < 0.01
    assert "a command that is not finite" in caplog.text


@pytest.mark.parametrize("tags, published, frames", [
    ({}, True, {"base_footprint"}),
    ({"publishOdomTF": "false"}, True, set()),
    ({"publishTf": "false"}, False, set()),
    ({"publishTf": "0", "publishWheelTF": "1"}, False, set()),
    ({"publishWheelTF": "true"}, True, {"base_footprint", "left", "right"}),
])
def test_transforms_and_odometry_are_switched_by_flags(bench, robot, tags, published, frames):
    # conforms: libgazebo_ros_diff_drive.so/publishTf, libgazebo_ros_diff_drive.so/publishOdomTF
    # conforms: libgazebo_ros_diff_drive.so/publishWheelTF
    bench.spawn(robot(**tags))
    odometry, tf = bench.listen("/odom"), bench.listen("/tf")
    bench.run(0.1)
    assert bool(odometry) == published
    assert set(transforms(tf)) == frames


def test_wheel_transforms_are_seen_from_the_model_but_named_after_the_parent(bench, robot):
    # conforms: libgazebo_ros_diff_drive.so/publishWheelTF
    bench.spawn(robot(publishWheelTF="true"))
    tf = bench.listen("/tf")
    bench.run(0.1)
    left = transforms(tf)["left"]
    assert left.header.frame_id == "base"
    assert left.transform.translation.z == pytest.approx(0.1, abs=0.005)  # not 0, as from the base
    assert left.transform.translation.y == pytest.approx(0.2, abs=0.005)


def test_wheel_joint_states_have_positions_only_left_first(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/publishWheelJointState
    car = bench.spawn(robot(publishWheelJointState="true", publishTf="false"))
    states = bench.listen("/joint_states")
    bench.send("/cmd_vel", command(0.0, 1.0))
    bench.run(0.5)
    assert states[-1].name == ["left_joint", "right_joint"]
    assert states[-1].position[0] == pytest.approx(car.joints["left_joint"].position, abs=0.05)
    assert states[-1].position[0] < 0 < states[-1].position[1]
    assert (states[-1].velocity, states[-1].effort) == ([], [])


def test_acceleration_limits_the_rim_unless_a_wheel_is_there_already(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/wheelAcceleration
    car = bench.spawn(robot(wheelAcceleration=0.5))
    bench.send("/cmd_vel", command(0.4))
    bench.run(0.4)
    assert car.twist.linear[0] == pytest.approx(0.2, abs=0.02)
    bench.run(0.6)
    assert car.twist.linear[0] == pytest.approx(0.4, abs=0.01)


def test_torque_bounds_what_the_motor_can_do(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/wheelTorque
    car = bench.spawn(robot(wheelTorque=0.02))
    bench.send("/cmd_vel", command(1.0))
    bench.run(0.5)
    # two motors push 7.5 kg with 0.4 N at the rim: 0.05 m/s^2
    assert 0.0 < car.twist.linear[0] < 0.05


def test_encoders_count_from_zero_and_speed_is_never_negative(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/odometrySource
    bench.spawn(robot(odometrySource="encoder"), Pose((3.0, 2.0, 0.0)))
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", command(-0.3))
    bench.run(1.0)
    assert odometry[-1].pose.pose.position.x == pytest.approx(-0.3, abs=0.02)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.3, rel=0.03)
    assert odometry[-1].pose.pose.position.z == 0.0


def test_world_odometry_has_the_full_pose(bench, robot):
    # conforms: libgazebo_ros_diff_drive.so/odometrySource
    bench.spawn(robot(odometrySource="world"), Pose((3.0, 2.0, 1.0)))
    odometry = bench.listen("/odom")
    bench.run(0.1)
    position = odometry[0].pose.pose.position
    assert (position.x, position.y) == pytest.approx((3.0, 2.0), abs=1e-3)
    assert position.z == pytest.approx(1.0, abs=0.05)


def test_reset_ends_command_and_encoders(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/odometrySource
    car = bench.spawn(robot(odometrySource="encoder"))
    odometry = bench.listen("/odom")
    bench.send("/cmd_vel", command(0.3))
    bench.run(0.5)
    bench.call("/gazebo/reset_simulation")
    odometry.clear()
    bench.run(0.5)
    assert odometry[0].header.stamp.to_sec() == pytest.approx(0.01)
    # the wheels still turn until the first update, 10 ms later
    assert abs(odometry[-1].pose.pose.position.x) < 4e-3
    assert abs(car.pose.position[0]) < 4e-3


@pytest.mark.parametrize("tags, turn", [
    ({}, 1), ({"legacyMode": "true"}, 1), ({"legacyMode": "false"}, -1)])
@pytest.mark.parametrize("source", ["world", "encoder"])
def test_a_left_wheel_on_the_right_is_one_from_before_melodic(bench, robot, command, caplog, tags,
                                                              turn, source):
    # conforms: libgazebo_ros_diff_drive.so/legacyMode
    car = bench.spawn(robot(leftJoint="right_joint", rightJoint="left_joint",
                            odometrySource=source, publishWheelJointState="true", **tags))
    odometry, states = bench.listen("/odom"), bench.listen("/joint_states")
    bench.send("/cmd_vel", command(0.2, 0.5))
    bench.run(1.0)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.2, abs=0.02)
    # Encoders know nothing of where the wheels are: they agree with the command in any case.
    seen = turn if source == "world" else 1
    assert odometry[-1].twist.twist.angular.z == pytest.approx(0.5 * seen, rel=0.1)
    faster = car.joints["right_joint" if turn > 0 else "left_joint"].velocity
    assert faster == pytest.approx((0.2 + 0.5 * 0.2) / 0.1, rel=0.05)
    assert states[-1].name == ["right_joint", "left_joint"]
    assert caplog.text.count("is the right wheel") == (1 if turn > 0 else 0)


@pytest.mark.parametrize("tags, forward, turn", [
    ({"wheelDiameter": -0.2}, -1, -1), ({"wheelSeparation": -0.4}, 1, -1)])
@pytest.mark.parametrize("legacy", ["true", "false"])
def test_negative_sizes_reverse_as_upstream(bench, robot, command, tags, forward, turn, legacy):
    # conforms: libgazebo_ros_diff_drive.so/wheelSeparation
    # conforms: libgazebo_ros_diff_drive.so/wheelDiameter
    # conforms: libgazebo_ros_diff_drive.so/legacyMode
    car = bench.spawn(robot(legacyMode=legacy, **tags))
    bench.send("/cmd_vel", command(0.0, 0.5))
    bench.run(1.0)
    # Unless told otherwise, files that turn the wrong way are from before Melodic.
    assert car.twist.angular[2] == pytest.approx(0.5 * (turn if legacy == "false" else 1), rel=0.05)
    start = car.pose
    bench.send("/cmd_vel", command(0.2))
    bench.run(0.5)
    assert (start.inverse() * car.pose).position[0] * forward == pytest.approx(0.1, rel=0.1)


@pytest.mark.parametrize("tags", [{"wheelDiameter": 0}, {"wheelSeparation": 0}])
def test_wheels_without_size_are_an_error(bench, robot, caplog, tags):
    # conforms: libgazebo_ros_diff_drive.so/wheelSeparation
    # conforms: libgazebo_ros_diff_drive.so/wheelDiameter
    bench.spawn(robot(**tags))
    assert "is not loaded: wheel diameter 0" in caplog.text
    assert "must not be 0 m" in caplog.text


def test_a_motor_of_negative_torque_is_none(bench, robot, command):
    # conforms: libgazebo_ros_diff_drive.so/wheelTorque
    car = bench.spawn(robot(wheelTorque=-5))
    bench.send("/cmd_vel", command(0.3))
    bench.run(0.5)
    assert car.twist.linear == pytest.approx((0, 0, 0), abs=1e-3)


@pytest.mark.parametrize("tags", [{}, {"legacyMode": "true"}, {"legacyMode": "false"}])
def test_a_left_wheel_on_the_left_turns_as_in_noetic(bench, robot, command, caplog, tags):
    # conforms: libgazebo_ros_diff_drive.so/legacyMode
    car = bench.spawn(robot(**tags))
    bench.send("/cmd_vel", command(0.2, 0.5))
    bench.run(1.0)
    assert car.joints["right_joint"].velocity == pytest.approx(3.0, rel=0.05)
    assert "is the right wheel" not in caplog.text


def test_what_is_wrong_is_said_and_what_can_go_on_goes_on(bench, robot, caplog):
    # conforms: libgazebo_ros_diff_drive.so/leftJoint, libgazebo_ros_diff_drive.so/rightJoint
    # conforms: libgazebo_ros_diff_drive.so/odometrySource
    with caplog.at_level(logging.INFO):
        bench.spawn(robot(odometrySource="moon"))
    assert "<odometrySource> is 'moon'; there are world and encoder; world is used" in caplog.text
    assert "Starting plugin DiffDrive(ns = /)" in caplog.text
    for line in ("Try to subscribe to cmd_vel", "Subscribe to cmd_vel", "Advertise odom on odom"):
        assert f"DiffDrive(ns = /): {line}" in caplog.text
    caplog.clear()
    bench.spawn(robot("other", leftJoint="nope", robotNamespace=None))
    assert "is not loaded: no joint of model other named 'nope'" in caplog.text
    assert "DiffDrive missing <robotNamespace>, defaults is other" in caplog.text
    assert "/other/cmd_vel" not in bench.subscribed()
    caplog.clear()
    bench.spawn(robot("lame", rightJoint="none"))
    assert "is not loaded: no joint of model lame named 'none'" in caplog.text
    caplog.clear()
    bench.spawn(robot("third", publishTf=None))
    assert "DiffDrive(ns = /): missing <publishTf> default is true" in caplog.text


@pytest.mark.parametrize("text", ["nan", "fast"])
def test_a_tag_that_is_no_number_is_said(bench, robot, caplog, text):
    # conforms: libgazebo_ros_diff_drive.so/wheelTorque
    bench.spawn(robot(wheelTorque=text))
    assert f"is not loaded: <wheelTorque> is '{text}', which is not a number" in caplog.text

"""Bases moved by force: hector's force_based_move and the libraries made of it."""

import math

import pytest

from bullet_sim.pose import Pose, quaternion_from_rpy

HECTOR = "libhector_gazebo_ros_force_based_move.so"
WPR = "libwpr_plugin.so"
RIDGEBACK = "libridgeback_ros_force_based_move.so"
ROBOTNIK = "librobotnik_force_based_move.so"
MASS = 40.0  # kg


@pytest.fixture
def base(robots):
    """`base(library, tag=value)`: a heavy box that slides, its frame in its middle."""
    def make(library: str, **tags) -> str:
        tags = {"robotBaseFrame": "body", "yaw_velocity_p_gain": 5, **tags}
        return robots.cube("bot", robots.plugin(library, **tags), mass=MASS)
    return make


@pytest.mark.parametrize("library", [HECTOR, WPR, RIDGEBACK, ROBOTNIK])
def test_it_reaches_the_wanted_velocity_in_its_own_heading(bench, base, robots, library):
    # conforms: libhector_gazebo_ros_force_based_move.so, libwpr_plugin.so
    # conforms: libridgeback_ros_force_based_move.so, librobotnik_force_based_move.so
    # conforms: libhector_gazebo_ros_force_based_move.so/robotBaseFrame
    # conforms: libwpr_plugin.so/robotBaseFrame, libridgeback_ros_force_based_move.so/robotBaseFrame
    # conforms: librobotnik_force_based_move.so/robotBaseFrame
    tags = {} if library != RIDGEBACK else {"x_velocity_p_gain": 2e4, "y_velocity_p_gain": 2e4}
    bot = bench.spawn(base(library, odometryRate=50, publishOdometryTf=1, **tags),
                      Pose((1.0, 2.0, 0.1), quaternion_from_rpy(0, 0, math.pi / 2)))
    odometry, tf = bench.listen("/odom"), bench.listen("/tf")
    for _ in range(5):
        bench.send("/cmd_vel", robots.command(0.4, 0.2, turn=0.5))
        bench.run(0.2)
    forward, leftward = 0.4, 0.2
    yaw = bot.pose.rpy()[2]
    assert yaw == pytest.approx(math.pi / 2 + 0.5, abs=0.05)
    speed = bot.twist.linear
    assert speed[0] * math.cos(yaw) + speed[1] * math.sin(yaw) == pytest.approx(forward, abs=0.03)
    assert speed[1] * math.cos(yaw) - speed[0] * math.sin(yaw) == pytest.approx(leftward, abs=0.03)
    last = odometry[-1]
    assert len(odometry) == len(tf) == 50
    assert last.twist.twist.linear.y == pytest.approx(leftward, abs=0.03)
    there = last.pose.pose.position  # from where it was spawned, not from the world's origin
    moved = (bot.pose.position[1] - 2.0, -(bot.pose.position[0] - 1.0))
    assert (there.x, there.y) == pytest.approx(moved, abs=0.01)
    assert last.pose.covariance[0] == 1e-3 and last.pose.covariance[35] == 100.0


@pytest.mark.parametrize("library, forward, leftward, yaw", [
    (HECTOR, 1e4, 1e4, 100), (ROBOTNIK, 1e4, 1e4, 100), (WPR, 4e4, 3e4, 500),
    (RIDGEBACK, 1e5, 1e5, 1e4)])
def test_gains(bench, robots, monkeypatch, library, forward, leftward, yaw):
    # conforms: libhector_gazebo_ros_force_based_move.so/x_velocity_p_gain
    # conforms: libhector_gazebo_ros_force_based_move.so/y_velocity_p_gain
    # conforms: libhector_gazebo_ros_force_based_move.so/yaw_velocity_p_gain
    # conforms: libwpr_plugin.so/x_velocity_p_gain, libwpr_plugin.so/y_velocity_p_gain
    # conforms: libwpr_plugin.so/yaw_velocity_p_gain
    # conforms: libridgeback_ros_force_based_move.so/x_velocity_p_gain
    # conforms: libridgeback_ros_force_based_move.so/y_velocity_p_gain
    # conforms: libridgeback_ros_force_based_move.so/yaw_velocity_p_gain
    # conforms: librobotnik_force_based_move.so/x_velocity_p_gain
    # conforms: librobotnik_force_based_move.so/y_velocity_p_gain
    # conforms: librobotnik_force_based_move.so/yaw_velocity_p_gain
    for tags, gains in (({}, (forward, leftward, yaw)), (
            {"x_velocity_p_gain": 7, "y_velocity_p_gain": 8, "yaw_velocity_p_gain": 9}, (7, 8, 9))):
        bot = bench.spawn(robots.cube("bot", robots.plugin(
            library, robotBaseFrame="body", **tags)), Pose((0, 0, 0.1)))
        pushes = []
        monkeypatch.setattr(bot.link("body"), "apply_force",
                            lambda force, torque, to=pushes: to.append((*force, *torque)))
        bench.send("/cmd_vel", robots.command(0.1, 0.2, turn=0.3))
        bench.run_steps(1)
        push = (0.1 * gains[0], 0.2 * gains[1], 0.0, 0.0, 0.0, 0.3 * gains[2])
        assert pushes[0] == pytest.approx(push, rel=0.01, abs=0.1)
        bench.delete("bot")


@pytest.mark.parametrize("library, tag, default", [
    (RIDGEBACK, "cmdVelTimeOut", 0.25), (ROBOTNIK, "commandWatchdog", 2.0), (WPR, "", math.inf),
    (HECTOR, "", math.inf)])
def test_how_long_a_command_stands(bench, base, robots, library, tag, default):
    # conforms: libridgeback_ros_force_based_move.so/cmdVelTimeOut
    # conforms: librobotnik_force_based_move.so/commandWatchdog
    gains = {"x_velocity_p_gain": 10000, "y_velocity_p_gain": 10000}
    for tags, limit in (({}, default), ({tag: 0.1} if tag else {}, 0.1 if tag else default)):
        bot = bench.spawn(base(library, **gains, **tags))
        bench.send("/cmd_vel", robots.command(0.3))
        bench.run(min(limit, 2.5) - 0.02)
        assert bot.twist.linear[0] == pytest.approx(0.3, abs=0.02)
        bench.run(0.15)
        wanted = 0.0 if limit < 3 else 0.3
        assert bot.twist.linear[0] == pytest.approx(wanted, abs=0.02)
        bench.delete("bot")


@pytest.mark.parametrize("library", [HECTOR, WPR, RIDGEBACK, ROBOTNIK])
def test_names_frames_and_rates(bench, base, library):
    # conforms: libhector_gazebo_ros_force_based_move.so/robotNamespace
    # conforms: libwpr_plugin.so/odometryRate
    # conforms: libhector_gazebo_ros_force_based_move.so/commandTopic, libwpr_plugin.so/commandTopic
    # conforms: libhector_gazebo_ros_force_based_move.so/odometryTopic
    # conforms: libhector_gazebo_ros_force_based_move.so/odometryFrame
    # conforms: libhector_gazebo_ros_force_based_move.so/odometryRate
    # conforms: libhector_gazebo_ros_force_based_move.so/publishOdometryTf
    # conforms: libwpr_plugin.so/robotNamespace, libwpr_plugin.so/odometryTopic
    # conforms: libwpr_plugin.so/odometryFrame, libwpr_plugin.so/publishOdometryTf
    # conforms: libridgeback_ros_force_based_move.so/robotNamespace
    # conforms: libridgeback_ros_force_based_move.so/commandTopic
    # conforms: libridgeback_ros_force_based_move.so/odometryTopic
    # conforms: libridgeback_ros_force_based_move.so/odometryFrame
    # conforms: libridgeback_ros_force_based_move.so/odometryRate
    # conforms: libridgeback_ros_force_based_move.so/publishOdometryTf
    # conforms: libridgeback_ros_force_based_move.so/cmdVelLinearMin
    # conforms: libridgeback_ros_force_based_move.so/cmdVelAngularMin
    # conforms: librobotnik_force_based_move.so/robotNamespace
    # conforms: librobotnik_force_based_move.so/commandTopic
    # conforms: librobotnik_force_based_move.so/odometryTopic
    # conforms: librobotnik_force_based_move.so/odometryFrame
    # conforms: librobotnik_force_based_move.so/odometryRate
    # conforms: librobotnik_force_based_move.so/publishOdometryTf
    bench.spawn(base(library))
    odometry, tf = bench.listen("/odom"), bench.listen("/tf")
    bench.run(1.0)
    assert len(odometry) == 20
    assert bool(tf) == (library != RIDGEBACK)
    bench.delete("bot")
    bench.spawn(base(library, robotNamespace="/ns", commandTopic="go", odometryTopic="way",
                     odometryFrame="o", odometryRate=100,
                     publishOdometryTf="true" if library == RIDGEBACK else "false"))
    odometry, tf = bench.listen("/ns/way"), bench.listen("/tf")
    assert "/ns/go" in bench.subscribed()
    bench.run(1.0)
    assert len(odometry) == 100
    assert (odometry[-1].header.frame_id, odometry[-1].child_frame_id) == ("o", "body")
    assert bool(tf) == (library == RIDGEBACK)


def test_a_base_that_is_not_there_is_said(bench, robots, caplog):
    # conforms: libwpr_plugin.so/robotBaseFrame
    bench.spawn(robots.cube("bot", robots.plugin(WPR)))
    assert "is not loaded: no link of model bot named 'base_footprint'" in caplog.text
    assert "/odom" not in bench.advertised()

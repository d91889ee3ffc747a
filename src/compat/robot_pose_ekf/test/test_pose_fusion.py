"""Wheels that turn wrong, an IMU that knows the way: the fusion, without ROS."""

import numpy as np
import pytest
from robot_pose_ekf.fusion import IMU_VARIANCE, Fusion

SPEED, TURN, PERIOD, SECONDS = 0.3, 0.4, 0.02, 20.0
WHEELS = np.diag([1e-3, 1e-3, 1e6, 1e6, 1e6, 1e-2])
IMU = np.diag([0.0, 0.0, 0.0] + [IMU_VARIANCE] * 3)


def circle(time, turn=TURN):
    """x y z roll pitch yaw (6,) after so many s."""
    yaw = turn * time
    return np.array([SPEED / turn * np.sin(yaw), SPEED / turn * (1 - np.cos(yaw)), 0, 0, 0,
                     np.arctan2(np.sin(yaw), np.cos(yaw))])


def drive(fusion, heading=0.0, until=SECONDS, silent=()):
    """Every sensor of the fusion at 50 Hz; the wheels turn 10 % too far."""
    for step in range(round(until / PERIOD) + 1):
        time = step * PERIOD
        for name, sensor in fusion.sensors.items():
            if name in silent:
                continue
            pose = circle(time, TURN * (1.1 if name == "odom" else 1.0))
            if name == "imu":
                pose[5] += heading
            sensor.take(time, pose, IMU if name == "imu" else WHEELS, time)
        fusion.update(time)


def off(fusion, time=SECONDS):
    return np.hypot(*(fusion.pose - circle(time))[:2])


def test_the_imu_puts_the_wheels_right_whatever_its_own_north_is():
    for heading in (0.0, 2.5):
        fused, alone = Fusion(["odom", "imu"], 1.0), Fusion(["odom"], 1.0)
        drive(fused, heading)
        drive(alone)
        assert off(alone) > 0.3
        assert off(fused) < 0.02
        assert fused.pose[5] == pytest.approx(circle(SECONDS)[5], abs=0.01)


def test_roll_and_pitch_are_the_imus():
    fusion = Fusion(["odom", "imu"], 1.0)
    for time in (0.0, 0.1, 0.2):
        fusion.sensors["odom"].take(time, np.zeros(6), WHEELS, time)
        fusion.sensors["imu"].take(time, np.array([0, 0, 0, 0.1, -0.2, 1.0]), IMU, time)
        fusion.update(time)
    np.testing.assert_allclose(fusion.pose[3:], [0.1, -0.2, 0.0], atol=1e-3)


def test_a_gps_says_where_the_robot_is():
    fusion = Fusion(["odom", "gps"], 1.0)
    drive(fusion, silent=("gps",), until=5.0)
    place = np.array([7.0, 8.0, 0.0, 0.0, 0.0, 0.0])
    for time in (5.1, 5.2, 5.3):
        fusion.sensors["odom"].take(time, circle(time), WHEELS * 1e3, time)
        fusion.sensors["gps"].take(time, place, np.eye(6) * 1e-4, time)
        fusion.update(time)
    np.testing.assert_allclose(fusion.pose[:2], [7.0, 8.0], atol=0.01)


def test_no_sensor_jumps_after_a_silence_and_the_clock_may_be_set_back():
    fusion = Fusion(["odom"], 1.0)
    drive(fusion, until=2.0)
    before = fusion.pose
    assert not fusion.update(4.0)
    for time in (5.0, 5.1):  # put elsewhere while it was silent
        fusion.sensors["odom"].take(time, np.full(6, 0.5), WHEELS, time)
        fusion.update(time)
    np.testing.assert_allclose(fusion.pose, before, atol=1e-6)
    fusion.sensors["odom"].take(0.1, circle(0.1), WHEELS, 0.1)
    assert fusion.update(0.1)
    np.testing.assert_allclose(fusion.pose, circle(0.1), atol=1e-6)


def test_nothing_begins_by_an_imu_alone():
    fusion = Fusion(["odom", "imu"], 1.0)
    drive(fusion, silent=("odom",), until=1.0)
    assert fusion.stamp is None and fusion.active(1.0) == ["imu"]

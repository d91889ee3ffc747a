"""Odometry from wheels, against circles whose ends are known."""

import math

import pytest
from car_control.driving.ackermann import (
    CarGeometry,
    HingeAngles,
    angle_from_curvature,
    hinge_angles,
    wheel_speeds,
)
from car_control.driving.dead_reckoning import DeadReckoning

CAR = CarGeometry(wheelbase=0.335, front_track=0.23, rear_track=0.23, wheel_radius=0.05)
STRAIGHT = HingeAngles(0.0, 0.0)


def drive(reckoning, speed, bend, seconds, steps=50, start=0.0, angles=(0.0, 0.0)):
    """At `speed`, m/s, along a curve of `bend`, 1/m; returns the wheels' angles at the end."""
    angle = angle_from_curvature(CAR, bend)
    wheels, hinges = wheel_speeds(CAR, speed, angle), hinge_angles(CAR, angle)
    for step in range(steps + 1):
        time = seconds * step / steps
        at = (angles[0] + wheels.left_rear * time, angles[1] + wheels.right_rear * time)
        reckoning.add(start + time, *at, hinges)
    return at


def test_straight_on():
    reckoning = DeadReckoning(CAR)
    drive(reckoning, 0.5, 0.0, 4.0)
    motion = reckoning.motion
    assert (motion.x, motion.y, motion.yaw) == pytest.approx((2.0, 0.0, 0.0))
    assert (motion.speed, motion.turn_rate) == pytest.approx((0.5, 0.0))


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_quarter_of_a_circle_to_the_left_ahead_and_back(speed):
    reckoning = DeadReckoning(CAR)
    drive(reckoning, speed, 1.0, math.pi / 2)
    motion = reckoning.motion
    assert (motion.x, motion.y, motion.yaw) == pytest.approx(
        (math.copysign(1, speed), 1.0, math.copysign(math.pi / 2, speed)))
    assert motion.turn_rate == pytest.approx(speed)


def test_yaw_stays_within_a_turn():
    reckoning = DeadReckoning(CAR)
    drive(reckoning, 1.0, -1.0, 3 * math.pi)
    assert abs(reckoning.motion.yaw) == pytest.approx(math.pi)


def test_a_clock_set_back_moves_nothing():
    reckoning = DeadReckoning(CAR)
    reckoning.add(5.0, 10.0, 10.0, STRAIGHT)
    reckoning.add(6.0, 20.0, 20.0, STRAIGHT)
    assert reckoning.motion.x == pytest.approx(0.5)
    reckoning.add(0.0, 0.0, 0.0, STRAIGHT)
    assert (reckoning.motion.x, reckoning.motion.speed) == pytest.approx((0.5, 0.0))
    reckoning.add(1.0, 2.0, 2.0, STRAIGHT)
    assert reckoning.motion.x == pytest.approx(0.6)

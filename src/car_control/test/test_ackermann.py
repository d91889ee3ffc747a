"""Wheels and hinges of an Ackermann car against the geometry of a circle."""

import math

import pytest
from car_control.driving.ackermann import (
    CarGeometry,
    HingeAngles,
    WheelSpeeds,
    angle_from_curvature,
    angle_from_hinges,
    curvature_from_angle,
    hinge_angles,
    sharpest_angle,
    wheel_speeds,
)

CAR = CarGeometry(wheelbase=0.335, front_track=0.23, rear_track=0.23, wheel_radius=0.05)
ANGLES = [-0.6, -0.34, -1e-9, 0.0, 0.05, 0.34, 0.6]


def test_each_front_wheel_stands_across_its_line_to_the_middle_of_the_circle():
    radius = 1.0  # m, to the left
    hinges = hinge_angles(CAR, angle_from_curvature(CAR, 1 / radius))
    assert hinges.left == pytest.approx(math.atan2(0.335, 1.0 - 0.115))
    assert hinges.right == pytest.approx(math.atan2(0.335, 1.0 + 0.115))


def test_each_wheel_rolls_on_a_circle_of_its_own():
    wheels = wheel_speeds(CAR, 2.0, angle_from_curvature(CAR, 1.0))
    turn = 2.0 / 1.0  # rad/s of the whole car
    assert wheels.left_rear * 0.05 == pytest.approx(turn * 0.885)
    assert wheels.right_rear * 0.05 == pytest.approx(turn * 1.115)
    assert wheels.left_front * 0.05 == pytest.approx(turn * math.dist((0, 0), (0.335, 0.885)))
    assert wheels.right_front * 0.05 == pytest.approx(turn * math.dist((0, 0), (0.335, 1.115)))


def test_straight_on_all_wheels_are_alike():
    assert hinge_angles(CAR, 0.0) == HingeAngles(0.0, 0.0)
    assert wheel_speeds(CAR, 2.0, 0.0) == WheelSpeeds(40.0, 40.0, 40.0, 40.0)
    assert wheel_speeds(CAR, -1.0, 0.0) == WheelSpeeds(-20.0, -20.0, -20.0, -20.0)


def test_right_is_the_mirror_of_left():
    left, right = hinge_angles(CAR, 0.3), hinge_angles(CAR, -0.3)
    assert (right.left, right.right) == (-left.right, -left.left)
    left, right = wheel_speeds(CAR, 1.0, 0.3), wheel_speeds(CAR, 1.0, -0.3)
    assert (right.left_rear, right.left_front) == (left.right_rear, left.right_front)


@pytest.mark.parametrize("angle", ANGLES)
def test_hinges_lead_back_to_the_command(angle):
    assert angle_from_hinges(CAR, hinge_angles(CAR, angle)) == pytest.approx(angle)
    assert angle_from_curvature(CAR, curvature_from_angle(CAR, angle)) == pytest.approx(angle)


@pytest.mark.parametrize("angle", [1.3, -1.3, math.inf, math.nan])
def test_an_angle_that_no_wheel_can_follow_is_refused(angle):
    assert sharpest_angle(CAR) == pytest.approx(math.atan(0.335 / 0.115))
    for law in (lambda: hinge_angles(CAR, angle), lambda: wheel_speeds(CAR, 1.0, angle)):
        with pytest.raises(ValueError, match=r"steering angle of .* within \+-1\.240 rad"):
            law()


def test_a_car_without_length_is_refused():
    with pytest.raises(ValueError, match="wheelbase must be more than 0 m, is 0"):
        CarGeometry(0.0, 0.23, 0.23, 0.05)

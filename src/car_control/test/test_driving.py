"""The laws of driving against closed forms: PID, Ackermann, wheel odometry, speeds on a path."""

import math

import numpy as np
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
from car_control.driving.dead_reckoning import DeadReckoning
from car_control.driving.pid import Pid, PidGains
from car_control.driving.speed_profile import SpeedLimits, bend_speed, speed_profile

PERIOD = 0.1  # s


def test_each_term_adds_its_part():
    pid = Pid(PidGains(kp=2.0, ki=3.0, kd=0.5))
    assert pid.compute(1.0, PERIOD) == pytest.approx(2 * 1 + 3 * 1 * 0.1)  # no derivative yet
    assert pid.compute(3.0, PERIOD) == pytest.approx(2 * 3 + 3 * (0.1 + 0.3) + 0.5 * 2 / 0.1)


def test_the_output_is_clamped_on_both_sides():
    pid = Pid(PidGains(kp=10.0, output_limit=0.34))
    assert [pid.compute(error, PERIOD) for error in (1.0, -1.0, 0.01)] == [0.34, -0.34, 0.1]


def test_the_sum_does_not_wind_up():
    pid = Pid(PidGains(kp=1.0, ki=1.0, output_limit=1.0))
    for _ in range(1000):
        assert pid.compute(5.0, PERIOD) == 1.0
    assert pid.compute(0.0, PERIOD) == 0.0  # nothing was summed up at the limit
    assert pid.compute(-0.5, PERIOD) < 0  # so the way back begins at once


def test_the_sum_still_leads_away_from_the_limit():
    pid = Pid(PidGains(kp=0.0, ki=1.0, output_limit=1.0))
    outputs = [pid.compute(0.4, 1.0) for _ in range(5)]
    assert outputs == pytest.approx([0.4, 0.8, 0.8, 0.8, 0.8])
    assert pid.compute(-0.3, 1.0) == pytest.approx(0.5)


def test_another_ki_makes_no_jump():
    pid = Pid(PidGains(kp=0.0, ki=1.0))
    for _ in range(10):
        pid.compute(1.0, PERIOD)
    pid.gains = PidGains(kp=0.0, ki=0.1)
    assert pid.compute(1.0, PERIOD) == pytest.approx(1.0 + 0.01)


def test_the_filtered_derivative_approaches_the_slope_with_its_time_constant():
    period, slope = 0.001, 4.0
    pid = Pid(PidGains(kp=0.0, kd=1.0, derivative_time=0.2))
    outputs = [pid.compute(slope * i * period, period) for i in range(1001)]
    assert outputs[200] == pytest.approx(slope * (1 - math.exp(-1)), rel=0.01)
    assert outputs[-1] == pytest.approx(slope, rel=0.01)


def test_reset_forgets_sum_and_derivative():
    pid = Pid(PidGains(kp=1.0, ki=1.0, kd=1.0))
    first = pid.compute(1.0, PERIOD)
    pid.compute(7.0, PERIOD)
    pid.reset()
    assert pid.compute(1.0, PERIOD) == first


def test_two_errors_at_one_moment_have_no_slope():
    pid = Pid(PidGains(kp=1.0, kd=1.0))
    pid.compute(1.0, PERIOD)
    assert pid.compute(2.0, 0.0) == 2.0


@pytest.mark.parametrize(("error", "period"), [(math.nan, 0.1), (1.0, -0.1), (1.0, math.inf)])
def test_what_is_no_number_is_refused_and_leaves_no_trace(error, period):
    pid = Pid(PidGains(kp=1.0, ki=1.0, kd=1.0))
    pid.compute(1.0, PERIOD)
    with pytest.raises(ValueError, match="must be finite"):
        pid.compute(error, period)
    assert pid.compute(1.0, PERIOD) == pytest.approx(1.2)


def test_a_loop_round_a_slow_car_comes_to_rest_on_the_line():
    pid, beside, angle = Pid(PidGains(kp=2.0, ki=0.5, kd=2.0, output_limit=0.4)), 0.3, 0.0
    for _ in range(400):  # a car at 1 m/s, small angles
        angle += pid.compute(-beside, 0.05) * 0.05
        beside += angle * 0.05
    assert abs(beside) < 0.005


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


LIMITS = SpeedLimits(speed=3.0, lateral_acceleration=4.0, acceleration=2.0, braking=3.0)
STEP = 0.05  # m


def test_a_bend_is_driven_at_its_grip_and_a_straight_at_full_speed():
    speeds = bend_speed(np.array([0.0, 1e-9, 1.0, -1.0, 0.25, 1e9]), LIMITS)
    assert speeds[:5] == pytest.approx([3.0, 3.0, 2.0, 2.0, 3.0])
    assert speeds[5] == pytest.approx(math.sqrt(4e-9))


def test_before_a_bend_the_car_brakes_just_in_time_and_after_it_speeds_up():
    curvature = np.zeros(201)
    curvature[100] = 4.0  # 1 m/s
    speeds = speed_profile(curvature, np.full(200, STEP), LIMITS)
    assert speeds[100] == pytest.approx(1.0)
    assert speeds[90] == pytest.approx(math.sqrt(1 + 2 * 3.0 * 10 * STEP))
    assert speeds[110] == pytest.approx(math.sqrt(1 + 2 * 2.0 * 10 * STEP))
    assert speeds[0] == speeds[-1] == 3.0


def test_a_standing_car_starts_from_its_own_speed():
    speeds = speed_profile(np.zeros(100), np.full(99, STEP), LIMITS, start_speed=0.5)
    assert speeds[0] == 0.5
    assert speeds[10] == pytest.approx(math.sqrt(0.25 + 2 * 2.0 * 10 * STEP))


@pytest.mark.parametrize("shift", [0, 1, 37, 99])
def test_on_a_closed_path_it_does_not_matter_where_it_begins(shift):
    curvature = np.zeros(100)
    curvature[[3, 40]] = 4.0, -2.0
    spacing = np.linspace(0.02, 0.08, 100)
    speeds = speed_profile(curvature, spacing, LIMITS, closed=True)
    moved = speed_profile(np.roll(curvature, shift), np.roll(spacing, shift), LIMITS, closed=True)
    assert moved == pytest.approx(np.roll(speeds, shift))
    assert speeds[2] == pytest.approx(math.sqrt(1 + 2 * 3.0 * spacing[2]))
    assert speeds[0] < 3.0  # brakes for the bend just after the place where the points begin


def test_no_limit_is_broken_anywhere():
    curvature = 2 * np.sin(np.arange(300) / 9.0) ** 3
    spacing = np.full(300, STEP)
    speeds = speed_profile(curvature, spacing, LIMITS, closed=True)
    change = np.roll(speeds, -1) ** 2 - speeds**2
    assert (speeds <= 3.0 + 1e-9).all() and (speeds**2 * np.abs(curvature) <= 4.0 + 1e-9).all()
    assert (change <= 2 * 2.0 * STEP + 1e-9).all() and (change >= -2 * 3.0 * STEP - 1e-9).all()


def test_points_and_spaces_must_fit():
    with pytest.raises(ValueError, match="5 points cannot have 5 spaces"):
        speed_profile(np.zeros(5), np.ones(5), LIMITS)


def test_a_limit_of_nothing_is_refused():
    with pytest.raises(ValueError, match="braking must be more than 0, is 0"):
        SpeedLimits(speed=1, lateral_acceleration=1, acceleration=1, braking=0)

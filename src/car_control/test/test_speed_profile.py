"""Speeds along a path against the formulas of even acceleration and of a bend's grip."""

import math

import numpy as np
import pytest
from car_control.driving.speed_profile import SpeedLimits, bend_speed, speed_profile

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

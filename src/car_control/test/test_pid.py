"""The PID law term by term, at its limit, and over many periods."""

import math

import pytest
from car_control.driving.pid import Pid, PidGains

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

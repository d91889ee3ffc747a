"""PID against series computed by hand, and the rates that controllers publish at."""

import math

import pytest

from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.control.rate import Rate
from bullet_sim.errors import SimulationError
from bullet_sim.pose import shortest_angular_distance

DT = 0.1  # s


def outputs(gains: PidGains, errors) -> list[float]:
    pid = Pid(gains)
    return [pid.compute(error, DT) for error in errors]


def test_proportional_integral_and_derivative_terms():
    errors = [1.0, 1.0, 0.5, -0.5]
    assert outputs(PidGains(p=2.0), errors) == [2.0, 2.0, 1.0, -1.0]
    # quotients: from 0 to 1, 1 to 1, 1 to 0.5, 0.5 to -0.5
    assert outputs(PidGains(d=0.1), errors) == pytest.approx([1.0, 0.0, -0.5, -1.0])
    wide = PidGains(i=10.0, i_clamp_max=100.0, i_clamp_min=-100.0)
    assert outputs(wide, errors) == pytest.approx([1.0, 2.0, 2.5, 2.0])


def test_without_a_clamp_the_integral_has_no_effect():
    assert outputs(PidGains(p=1.0, i=10.0), [1.0, 1.0, 1.0]) == [1.0, 1.0, 1.0]
    assert outputs(PidGains(p=1.0, i=10.0), [-1.0, -1.0]) == [-1.0, -1.0]


def test_the_clamp_holds_the_term_but_the_error_winds_up():
    gains = PidGains(i=10.0, i_clamp_max=1.5, i_clamp_min=-0.5)
    # integral of the error: 0.1 0.2 0.3 0.2 0.1 0 -0.1
    errors = [1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]
    assert outputs(gains, errors) == pytest.approx([1.0, 1.5, 1.5, 1.5, 1.0, 0.0, -0.5])


def test_antiwindup_clamps_the_integral_itself():
    gains = PidGains(i=10.0, i_clamp_max=1.5, i_clamp_min=-0.5, antiwindup=True)
    errors = [1.0, 1.0, 1.0, -1.0, -1.0]
    assert outputs(gains, errors) == pytest.approx([1.0, 1.5, 1.5, 0.5, -0.5])
    negative = PidGains(i=-10.0, i_clamp_max=1.5, i_clamp_min=-0.5, antiwindup=True)
    assert outputs(negative, [1.0, 1.0, -1.0]) == pytest.approx([-0.5, -0.5, 0.5])


def test_a_known_error_rate_takes_the_place_of_the_quotient():
    pid = Pid(PidGains(p=1.0, d=0.5))
    assert pid.compute(1.0, DT, error_rate=-2.0) == 0.0
    assert pid.compute(1.0, DT) == 1.0  # and its error counts for the next quotient


@pytest.mark.parametrize("error", [math.nan, math.inf, -math.inf])
def test_what_is_no_finite_number_gives_nothing_and_leaves_no_trace(error):
    pid = Pid(PidGains(p=1.0, i=1.0, d=1.0, i_clamp_max=9.0, i_clamp_min=-9.0))
    pid.compute(1.0, DT)
    assert pid.compute(error, DT) == 0.0
    assert pid.compute(1.0, DT, error_rate=error) == 0.0
    assert pid.compute(1.0, 0.0) == 0.0
    assert pid.compute(1.0, DT) == pytest.approx(1.0 + 0.2 + 0.0)


def test_reset_forgets():
    pid = Pid(PidGains(i=1.0, d=1.0, i_clamp_max=9.0, i_clamp_min=-9.0))
    first = pid.compute(2.0, DT)
    pid.reset()
    assert pid.compute(2.0, DT) == first


@pytest.mark.parametrize(("start", "to", "turn"), [
    (0.0, 1.0, 1.0), (3.0, -3.0, 2 * math.pi - 6.0), (-3.0, 3.0, 6.0 - 2 * math.pi),
    (0.0, math.pi, math.pi), (100.0, 100.5, 0.5), (0.0, 20 * math.pi + 0.25, 0.25),
])
def test_the_shorter_way_round(start, to, turn):
    assert shortest_angular_distance(start, to) == pytest.approx(turn)


def due_ticks(rate_hz: float, ticks) -> list[int]:
    rate = Rate(rate_hz)
    return [tick for tick in ticks if rate.due(tick * 0.001)]


def test_a_pace_is_exact_in_the_long_run():
    assert due_ticks(50.0, range(1, 62)) == [1, 21, 41, 61]
    assert len(due_ticks(30.0, range(30000))) == 900
    assert due_ticks(0.0, range(3)) == [0, 1, 2]
    assert len(due_ticks(5000.0, range(100))) == 100
    with pytest.raises(SimulationError, match="-1"):
        Rate(-1.0)


def test_a_pace_begins_anew_when_time_is_reset_or_stood_still():
    rate = Rate(10.0)
    assert [rate.due(t) for t in (5.0, 5.05, 5.1)] == [True, False, True]
    assert [rate.due(t) for t in (0.0, 0.05, 0.1)] == [True, False, True]
    assert [rate.due(t) for t in (9.0, 9.05, 9.1)] == [True, False, True]

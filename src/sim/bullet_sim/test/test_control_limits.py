"""Limits of joints: what is left of a command, for each kind of command."""

import math
from types import SimpleNamespace

import pytest

from bullet_sim.control.limits import LIMITERS
from bullet_sim.description import JointLimits, SoftLimits

DT = 0.01  # s


def limited(interface, limits, command, position=0.0, velocity=0.0):
    joint = SimpleNamespace(position=position, velocity=velocity)
    return LIMITERS[interface](joint, limits).apply(command, DT)


def test_no_limits_change_nothing():
    for interface in LIMITERS:
        assert limited(interface, JointLimits(), 1e5) == 1e5


@pytest.mark.parametrize(("command", "position", "velocity", "left"), [
    (9.0, 0.0, 0.0, 2.0), (-9.0, 0.0, 0.0, -2.0), (1.0, 0.0, 0.0, 1.0),
    (1.0, 0.6, 0.0, 0.0), (-1.0, 0.6, 0.0, -1.0),  # beyond the upper limit: only back
    (-1.0, -0.6, 0.0, 0.0), (1.0, -0.6, 0.0, 1.0),
    (1.0, 0.0, 3.1, 0.0), (-1.0, 0.0, 3.1, -1.0),  # too fast: only slower
    (-1.0, 0.0, -3.1, 0.0),
])
def test_effort(command, position, velocity, left):
    limits = JointLimits(-0.5, 0.5, velocity=3.0, effort=2.0)
    assert limited("effort", limits, command, position, velocity) == left


def test_zero_is_a_limit():
    assert limited("effort", JointLimits(effort=0.0), 1.0) == 0.0
    assert limited("velocity", JointLimits(velocity=0.0), 1.0) == 0.0
    assert limited("position", JointLimits(velocity=0.0), 1.0, position=0.25) == 0.25


def test_a_position_moves_no_faster_than_the_velocity_limit():
    joint = SimpleNamespace(position=0.1, velocity=0.0)
    limiter = LIMITERS["position"](joint, JointLimits(-0.5, 0.13, velocity=2.0))
    assert [limiter.apply(1.0, DT) for _ in range(3)] == pytest.approx([0.12, 0.13, 0.13])
    assert limiter.apply(-1.0, DT) == pytest.approx(0.11)
    limiter.reset()
    joint.position = 0.0
    assert limiter.apply(1.0, DT) == pytest.approx(0.02)


def test_a_velocity_and_its_acceleration():
    limits = JointLimits(velocity=1.0, acceleration=30.0)
    limiter = LIMITERS["velocity"](SimpleNamespace(position=0.0, velocity=0.0), limits)
    assert [limiter.apply(9.0, DT) for _ in range(5)] == pytest.approx([0.3, 0.6, 0.9, 1.0, 1.0])
    assert limiter.apply(-9.0, DT) == pytest.approx(0.7)


SOFT = JointLimits(-1.0, 1.0, velocity=2.0, effort=10.0,
                   soft=SoftLimits(-0.9, 0.8, k_position=10.0, k_velocity=5.0))


def test_soft_limits_slow_a_velocity_down():
    # 10 per rad that is left to 0.8, at most 2
    assert limited("velocity", SOFT, 9.0, position=0.0) == 2.0
    assert limited("velocity", SOFT, 9.0, position=0.7) == pytest.approx(1.0)
    assert limited("velocity", SOFT, 9.0, position=0.8) == pytest.approx(0.0)
    assert limited("velocity", SOFT, 9.0, position=0.9) == pytest.approx(-1.0)  # back
    assert limited("velocity", SOFT, -9.0, position=-0.8) == pytest.approx(-1.0)


def test_soft_limits_slow_a_position_down():
    assert limited("position", SOFT, 9.0, position=0.7) == pytest.approx(0.7 + 1.0 * DT)
    assert limited("position", SOFT, 9.0, position=1.5) == pytest.approx(1.0)


def test_soft_limits_of_an_effort():
    # 5 per rad/s that is left: 2 rad/s in the middle, -1 beyond the soft limit
    assert limited("effort", SOFT, 99.0, velocity=1.0) == pytest.approx(5.0)
    assert limited("effort", SOFT, 99.0, position=0.9) == pytest.approx(-5.0)
    assert limited("effort", SOFT, 99.0, position=-0.5, velocity=-2.0) == 10.0


def test_soft_limits_without_a_way_are_only_the_velocity_limit():
    soft = SoftLimits(k_position=10.0, k_velocity=5.0)
    limits = JointLimits(velocity=2.0, effort=10.0, soft=soft)
    assert limited("velocity", limits, math.inf, position=7.0) == 2.0

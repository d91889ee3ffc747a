"""Limits of joints; parameters of controllers and joints, with errors that name them."""

import math
from types import SimpleNamespace
from xml.etree.ElementTree import fromstring

import pytest

from bullet_sim.control.hardware import read_joint_gains, read_joint_limits
from bullet_sim.control.limits import LIMITERS
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.pid import PidGains
from bullet_sim.description import JointLimits, SoftLimits
from bullet_sim.errors import PluginError
from bullet_sim.formats.urdf.facts import RobotFacts

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


def parameters(values):
    return ControllerParameters("/r/c", values)


def test_parameters_are_typed_and_errors_name_them():
    p = parameters({"pid": {"p": 3}, "joint": "a", "flag": True, "list": [1, 2.5]})
    assert (p.number("pid/p"), p.number("pid/i", 0.0)) == (3.0, 0.0)
    assert (p.text("joint"), p.texts("joint"), p.flag("flag")) == ("a", ["a"], True)
    assert (p.numbers("list", 2), p.has("pid"), p.has("pid/d")) == ([1.0, 2.5], True, False)
    for read, part in ((lambda: p.number("pid/d"), "/r/c/pid/d is not set$"),
                       (lambda: p.number("joint"), "/r/c/joint is 'a', which is not a number"),
                       (lambda: p.text("flag"), "which is not a name"),
                       (lambda: p.flag("joint"), "not true or false"),
                       (lambda: p.texts("list"), "not a list of names"),
                       (lambda: p.numbers("list", 3), "not a list of 3 numbers"),
                       (lambda: parameters(None).text("joint"), "/r/c/joint is not set")):
        with pytest.raises(PluginError, match=part):
            read()


ARM = """<robot name="r"><link name="base"/><link name="arm"/>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
<limit lower="-1" upper="1" velocity="3" effort="2"/></joint></robot>"""


def test_limits_and_gains_of_joints_may_be_parameters():
    p = ControllerParameters("/r", {
        "joint_limits": {"j": {"has_position_limits": False, "max_position": 0.5,
                               "has_effort_limits": True, "max_effort": 7,
                               "has_acceleration_limits": True, "max_acceleration": 9.0}},
        "gazebo_ros_control": {"pid_gains": {"j": {
            "p": 5, "i": 1.0, "i_clamp": 2.0, "i_clamp_min": -0.5, "antiwindup": True}}},
    })
    limits = read_joint_limits(p, RobotFacts(fromstring(ARM)), ["j"])["j"]
    assert limits == JointLimits(velocity=3.0, acceleration=9.0, effort=7.0)
    gains = read_joint_gains(p, ["j", "other"])
    assert gains == {"j": PidGains(5.0, 1.0, 0.0, 2.0, -0.5, True)}
    p = ControllerParameters("/", None)
    assert read_joint_limits(p, RobotFacts(fromstring(ARM)), ["j"])["j"].lower == -1.0
    assert read_joint_gains(p, ["j"]) == {}


def test_an_error_within_a_group_names_the_whole_parameter():
    limits = {"joint_limits": {"j": {"has_effort_limits": "yes"}}}
    for namespace in ("/", ""):
        with pytest.raises(PluginError, match="parameter /joint_limits/j/has_effort_limits is 'yes'"
                                              ", which is not true or false"):
            read_joint_limits(ControllerParameters(namespace, limits),
                              RobotFacts(fromstring(ARM)), ["j"])

"""Parameters of controllers and joints, typed and with errors that name them."""

from xml.etree.ElementTree import fromstring

import pytest

from bullet_sim.control.hardware import read_joint_gains, read_joint_limits
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.pid import PidGains
from bullet_sim.description import JointLimits
from bullet_sim.errors import PluginError
from bullet_sim.formats.urdf.facts import RobotFacts


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

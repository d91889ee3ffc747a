"""roslaunch ends by a refusal of our programs alone; other faults stay its own."""

from types import SimpleNamespace

import pytest
from headless_highgui.launch_end import amend_loader

GUARD = "/share/bullet_sim_ros/scripts/unless_running true"


@pytest.mark.parametrize("command, code, ends", [
    (GUARD, "returned with code [1]", SystemExit),
    (GUARD, "no such command", ValueError),
    ("/share/xacro/xacro /share/turtlebot3_wafle.urdf.xacro", "returned with code [3]", SystemExit),
    ("rosrun xacro xacro.py turtlebot3_wafle.urdf.xacro", "returned with code [3]", SystemExit),
    ("/share/turtlebot3_slam/scripts/not_this_method karto", "returned with code [1]", SystemExit),
    ("/share/xacro/xacro robot.xacro", "returned with code [2]", ValueError),
    ("xacro robot.xacro", "returned with code [1]", ValueError),
    ("mine.py xacro robot.urdf", "returned with code [3]", ValueError),
    ("mine robot.xacro.txt", "returned with code [3]", ValueError),
    (None, "returned with code [1]", ValueError)])
def test_only_a_refusal_ends_it(command, code, ends):
    class Loader:
        def param_value(self, _verbose, name, _type, _value, _textfile, _binfile, _command):
            raise ValueError(f"Cannot load command parameter [{name}]: {code}")

    amend_loader(SimpleNamespace(Loader=Loader))
    with pytest.raises(ends) as ended:
        Loader().param_value(False, "/use_sim_time", "auto", None, None, None, command)
    assert ends is ValueError or ended.value.code == 1


def test_a_value_is_passed_on():
    class Loader:
        def param_value(self, *words):
            return words

    amend_loader(SimpleNamespace(Loader=Loader))
    assert Loader().param_value(False, "/use_sim_time", GUARD) == (False, "/use_sim_time", GUARD)

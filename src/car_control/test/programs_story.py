#!/usr/bin/env python3
"""Programs that the tests start, one class after another: the keyboard, settings of all nodes."""

import sys

import rospy
import rostest
from keyboard_terminal import KeyboardTerminal  # noqa: F401, rostest finds both by this module's name
from settings_runs import SettingsRuns  # noqa: F401

if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("car_control", "programs", "__main__", sys.argv)

#!/usr/bin/env python3
"""Programs that the tests start, one class after another: the keys, and then the window."""

import sys

import rospy
import rostest
from teleop_story import TeleopStory  # noqa: F401, rostest finds both by this module's name
from window_story import WindowStory  # noqa: F401

if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("turtlesim", "programs", "__main__", sys.argv)

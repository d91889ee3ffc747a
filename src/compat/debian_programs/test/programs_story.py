#!/usr/bin/env python3
"""The programs, one class after another: the frames' tree, and then pictures republished."""

import sys

import rospy
import rostest
from draws_frames import DrawsFrames  # noqa: F401, rostest finds both by this module's name
from republishes_images import Republish  # noqa: F401

if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("debian_programs", "programs", "__main__", sys.argv)

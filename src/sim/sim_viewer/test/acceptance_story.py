#!/usr/bin/env python3
"""What the page promises, with one simulator: what it shows, and how it drives and stops."""

import sys
import unittest

import rospy
import rostest
from driving_story import Driving, Keys
from showing_story import Showing


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Showing), load(Driving), load(Keys)])


if __name__ == "__main__":
    rospy.init_node("acceptance", disable_rostime=True)
    rostest.rosrun("sim_viewer", "acceptance", "acceptance_story.Suite", sys.argv)

#!/usr/bin/env python3
"""A held button and a stick drive."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist


class Drives(unittest.TestCase):
    def test_drives(self):
        command = rospy.wait_for_message("/cmd_vel", Twist, 60.0)
        self.assertAlmostEqual(command.linear.x, 0.7, places=5)
        self.assertAlmostEqual(command.angular.z, 0.2, places=5)


if __name__ == "__main__":
    rospy.init_node("drives")
    rostest.rosrun("teleop_twist_joy", "drives", Drives, sys.argv)

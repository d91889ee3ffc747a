#!/usr/bin/env python3
"""The launch file's remapping holds, and `active` names who drives."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from std_msgs.msg import String


class Drives(unittest.TestCase):
    def test_drives(self):
        command = rospy.wait_for_message("/mobile_base/commands/velocity", Twist, 60.0)
        self.assertEqual(command.linear.x, 0.3)
        self.assertEqual(rospy.wait_for_message("/cmd_vel_mux/active", String, 60.0).data,
                         "Keyboard")


if __name__ == "__main__":
    rospy.init_node("drives")
    rostest.rosrun("yocs_cmd_vel_mux", "drives", Drives, sys.argv)

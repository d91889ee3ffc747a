#!/usr/bin/env python
import unittest

import rospy
import rostest
from shape_msgs.msg import Reading


class TestTalks(unittest.TestCase):
    def test_reading(self):
        rospy.init_node("talks")
        self.assertEqual(rospy.wait_for_message("reading", Reading, 20).value, 42.0)


if __name__ == "__main__":
    rostest.rosrun("shape_tests", "talks", TestTalks)

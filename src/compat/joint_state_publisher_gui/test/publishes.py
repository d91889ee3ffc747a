#!/usr/bin/env python3
"""Without a screen the joints are published all the same."""

import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState


class Publishes(unittest.TestCase):
    def test_publishes(self):
        state = rospy.wait_for_message("/joint_states", JointState, 60.0)
        self.assertEqual((state.name, list(state.position)), (["elbow"], [0.0]))


if __name__ == "__main__":
    rospy.init_node("publishes")
    rostest.rosrun("joint_state_publisher_gui", "publishes", Publishes, sys.argv)

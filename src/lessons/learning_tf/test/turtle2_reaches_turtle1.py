#!/usr/bin/env python3
"""turtle2 comes to turtle1 within 15 s, and follows when it is put elsewhere."""

import math
import sys
import time
import unittest

import rospy
import rostest
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

LIMIT = 15.0  # s
NEAR = 1.0  # m


class Follow(unittest.TestCase):
    def setUp(self):
        self.poses = {}
        self.subscribers = [rospy.Subscriber(f"/{name}/pose", Pose, self.keep, name)
                            for name in ("turtle1", "turtle2")]

    def keep(self, pose, name):
        self.poses[name] = pose

    def distance(self):
        one, two = self.poses["turtle1"], self.poses["turtle2"]
        return math.hypot(one.x - two.x, one.y - two.y)

    def wait_until_near(self):
        end = time.monotonic() + LIMIT
        while len(self.poses) < 2 or self.distance() > NEAR:
            self.assertLess(time.monotonic(), end, f"not near: {self.poses}")
            time.sleep(0.05)

    def test_follows(self):
        self.wait_until_near()
        rospy.wait_for_service("/turtle1/teleport_absolute", LIMIT)
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(9.0, 2.0, 0.0)
        end = time.monotonic() + LIMIT
        while self.distance() < 2.0:
            self.assertLess(time.monotonic(), end, "turtle1 was not put elsewhere")
            time.sleep(0.01)
        self.wait_until_near()


if __name__ == "__main__":
    rospy.init_node("turtle2_reaches_turtle1")
    rostest.rosrun("learning_tf", "follow", Follow, sys.argv)

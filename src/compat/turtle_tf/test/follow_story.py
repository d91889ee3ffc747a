#!/usr/bin/env python3
"""The demo: turtle2 comes to turtle1, and comes again when turtle1 has gone elsewhere."""

import math
import re
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PointStamped
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

NEAR = 1.0  # m
REACH_LIMIT = 60.0  # s
TRANSLATION = re.compile(r"- Translation: \[(\S+), (\S+), (\S+)\]")


class Turtle:
    """The last pose of a turtle."""

    def __init__(self, name):
        self.pose, self.came = None, threading.Event()
        rospy.Subscriber(f"/{name}/pose", Pose, self.keep, queue_size=1)

    def keep(self, pose):
        self.pose = pose
        self.came.set()


def jump(turtle, x, y):
    name = f"/{turtle}/teleport_absolute"
    rospy.wait_for_service(name, REACH_LIMIT)
    rospy.ServiceProxy(name, TeleportAbsolute)(x, y, 0.0)


class FollowStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.leader, cls.follower = Turtle("turtle1"), Turtle("turtle2")
        for turtle in (cls.leader, cls.follower):
            assert turtle.came.wait(REACH_LIMIT), "a turtle did not come"

    def distance(self):
        here, there = self.leader.pose, self.follower.pose
        return math.hypot(here.x - there.x, here.y - there.y)

    def wait_until(self, condition, what):
        end = time.monotonic() + REACH_LIMIT
        while not condition():
            self.assertLess(time.monotonic(), end, f"waited in vain for {what}")
            time.sleep(0.02)

    def test_the_follower_reaches_the_leader_wherever_it_is(self):
        self.wait_until(lambda: self.distance() < NEAR, "the follower")
        for x, y in ((1.0, 10.0), (10.0, 1.0)):
            jump("turtle1", x, y)
            self.wait_until(lambda: self.distance() > 3 * NEAR, "the leader's jump")
            self.wait_until(lambda: self.distance() < NEAR, "the follower")

    def test_tf_echo_tells_where_the_other_turtle_is(self):
        jump("turtle1", 4.0, 9.0)
        self.wait_until(lambda: self.leader.pose.x == 4.0 and self.distance() < NEAR, "standing")
        echo = subprocess.Popen(["rosrun", "tf", "tf_echo", "turtle1", "turtle2"], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            found = next(match for line in echo.stdout if (match := TRANSLATION.search(line)))
        finally:
            echo.kill()
            echo.wait()
            echo.stdout.close()
        x, y, z = map(float, found.groups())
        self.assertLess(math.hypot(x, y), NEAR + 0.1)
        self.assertEqual(z, 0.0)

    def test_the_sensor_publishes_turtle3_in_the_world(self):
        turtle3 = Turtle("turtle3")
        self.wait_until(lambda: turtle3.pose and turtle3.pose.linear_velocity == 1, "turtle3")
        self.assertEqual(turtle3.pose.angular_velocity, 1.0)

        def beside():
            point = rospy.wait_for_message("/turtle_point_stamped", PointStamped, REACH_LIMIT)
            self.assertEqual(point.header.frame_id, "world")
            place, pose = point.point, turtle3.pose
            return math.hypot(place.x - pose.x, place.y - pose.y) < 0.5

        self.wait_until(beside, "turtle3 where the sensor has it")


if __name__ == "__main__":
    rospy.init_node("follow_story")
    rostest.rosrun("turtle_tf", "follow_story", FollowStory, sys.argv)

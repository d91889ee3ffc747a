#!/usr/bin/env python3
"""Lesson 7 follows, turns to where the line was lost, and stands still without images."""

import sys
import time
import unittest

import rospy
import rostest
from stand_in_camera import WIDTH, StandInCamera, stands


class Lesson07(unittest.TestCase):
    def test_follows_searches_and_stands_still(self):
        camera = StandInCamera(WIDTH // 2 + 200)
        right = camera.next_command(lambda c: c.linear.x > 0, "driving")
        self.assertAlmostEqual(right.linear.x, 0.1)  # the parameter, not the script's
        self.assertLess(right.angular.z, 0)

        camera.column = None
        search = camera.next_command(lambda c: c.linear.x == 0, "searching")
        self.assertAlmostEqual(search.angular.z, -0.5)

        camera.column = WIDTH // 2 - 250
        camera.next_command(lambda c: c.linear.x > 0, "driving again")
        camera.column = None
        search = camera.next_command(lambda c: c.linear.x == 0, "searching on the other side")
        self.assertAlmostEqual(search.angular.z, 0.5)

        camera.column = WIDTH // 2
        camera.next_command(lambda c: c.linear.x > 0, "driving a third time")
        camera.sends = False
        begin = time.monotonic()
        camera.next_command(stands, "standing still without images")
        self.assertLess(time.monotonic() - begin, 15.0)

        camera.sends = True
        camera.next_command(lambda c: c.linear.x > 0, "driving when images are back")


if __name__ == "__main__":
    rospy.init_node("lesson_07_stands_still")
    rostest.rosrun("learning_topic", "lesson_07", Lesson07, sys.argv)

#!/usr/bin/env python3
"""Lesson 5 steers towards the line, stops when it is lost, and stops when it is ended."""

import sys
import unittest

import rosnode
import rospy
import rostest
from stand_in_camera import WIDTH, StandInCamera, stands, wait_until


class Lesson05(unittest.TestCase):
    def test_steers_stops_and_ends(self):
        camera = StandInCamera(WIDTH // 2 + 100)
        right = camera.next_command(lambda c: c.linear.x > 0, "driving")
        self.assertAlmostEqual(right.linear.x, 0.15)
        self.assertAlmostEqual(right.angular.z, -0.1)

        camera.column = WIDTH // 2 - 200
        left = camera.next_command(lambda c: c.angular.z > 0, "turning left")
        self.assertAlmostEqual(left.angular.z, 0.2)

        camera.column = None
        camera.next_command(stands, "standing still without a line")

        camera.column = WIDTH // 2
        camera.next_command(lambda c: c.linear.x > 0, "driving again")
        rosnode.kill_nodes(["/follower"])
        wait_until(lambda: stands(camera.commands[-1]), "a stop as the last command")


if __name__ == "__main__":
    rospy.init_node("lesson_05_steers")
    rostest.rosrun("learning_topic", "lesson_05", Lesson05, sys.argv)

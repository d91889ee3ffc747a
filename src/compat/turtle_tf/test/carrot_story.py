#!/usr/bin/env python3
"""Frames by the demos' broadcasters, and turtle2 going to the one that is no turtle."""

import math
import subprocess
import sys
import time
import unittest

import rospy
import rostest
import tf2_ros

LIMIT = 60.0  # s
CARROT = (0.0, 2.0)  # m, in turtle1's frame


class CarrotStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)

    def place(self, frame, parent):
        """(x, y) of a frame's origin, or None while it is not known."""
        try:
            found = self.buffer.lookup_transform(parent, frame, rospy.Time())
        except tf2_ros.TransformException:
            return None
        return found.transform.translation.x, found.transform.translation.y

    def wait_for_place(self, frame, parent, x, y, within):
        end = time.monotonic() + LIMIT
        while (found := self.place(frame, parent)) is None or math.dist(found, (x, y)) > within:
            self.assertLess(time.monotonic(), end, f"{frame} in {parent} is {found}")
            time.sleep(0.02)

    def start(self, which):
        command = ["rosrun", *rospy.get_param(f"~{which}").split()]
        node = subprocess.Popen(command)
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)

    def test_turtle1_is_where_it_stands(self):
        self.wait_for_place("turtle1", "world", 5.544445, 5.544445, 1e-5)

    def test_turtle2_goes_to_the_carrot_beside_turtle1(self):
        self.start("fixed")
        self.wait_for_place("carrot1", "turtle1", *CARROT, within=1e-9)
        self.wait_for_place("turtle2", "carrot1", 0, 0, within=0.5)

    def test_the_dynamic_carrot_circles_at_ten_metres(self):
        self.start("dynamic")
        for y in (10.0, -10.0):
            self.wait_for_place("carrot1", "turtle1", 0, y, within=4.0)
        self.assertAlmostEqual(math.hypot(*self.place("carrot1", "turtle1")), 10.0, places=6)

    def test_without_a_turtle_one_line(self):
        command = ["rosrun", *rospy.get_param("~broadcaster").split()]
        done = subprocess.run(command, text=True, capture_output=True, timeout=LIMIT)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("_turtle:=turtle1", done.stderr)


if __name__ == "__main__":
    rospy.init_node("carrot_story")
    rostest.rosrun("turtle_tf", "carrot_story", CarrotStory, sys.argv)

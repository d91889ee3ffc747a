#!/usr/bin/env python3
"""A track of one's own: make_track writes it, the line that it prints starts the car on it."""

import os
import signal
import subprocess
import tempfile
import unittest

import numpy as np
import rospy
import rostest
from acceptance_car import LIMIT, Driver, Truth, all_running, init_node, wait_until
from sensor_msgs.msg import Image, LaserScan

MAKE = ("rosrun", "racecar_description", "make_track", "--random", "3", "--size", "12x8", "--walls")
ROWS = (500, 600, 700)  # px, of the camera's picture: road ahead
RIGHT, LEFT = slice(85, 96), slice(445, 456)  # beams of the laser, square to the car
WALL = 0.6  # m: the road's walls are nearer to its middle


class Track(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        made = subprocess.run([*MAKE, "--out", folder.name], capture_output=True, text=True,
                              timeout=LIMIT)
        assert made.returncode == 0, made.stderr
        command = made.stdout.splitlines()[-1]
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
        launched = subprocess.Popen(["bash", "-c", command], env=environment,
                                    start_new_session=True)
        cls.addClassCleanup(launched.wait)
        cls.addClassCleanup(os.killpg, launched.pid, signal.SIGINT)
        init_node("acceptance_track")
        wait_until(all_running, f"seven running controllers after: {command}")
        cls.truth = Truth()

    def test_1_the_car_stands_on_the_line_between_the_walls(self):
        self.truth.time_until_standing(self.truth.now.time)
        here = self.truth.now
        np.testing.assert_allclose((here.x, here.y, here.z, here.yaw), 0.0, atol=2e-3)
        image = rospy.wait_for_message("/camera/image_raw", Image, LIMIT)
        rgb = np.frombuffer(image.data, np.uint8).reshape(720, 1280, 3).astype(int)
        yellow = (rgb[..., 0] > 150) & (rgb[..., 1] > 130) & (rgb[..., 2] < 90)
        for row in ROWS:
            self.assertAlmostEqual(np.flatnonzero(yellow[row]).mean(), 639.5, delta=5)
        ranges = np.array(rospy.wait_for_message("/scan", LaserScan, LIMIT).ranges)
        self.assertLess(max(np.median(ranges[RIGHT]), np.median(ranges[LEFT])), WALL)

    def test_2_it_drives_a_metre(self):
        driver = Driver()
        self.addCleanup(driver.end)
        driver.drive(1.0, 0.0)
        wait_until(lambda: self.truth.now.x > 1.0, f"a metre; {self.truth.now}")
        driver.drive(0.0, 0.0)
        self.truth.time_until_standing(self.truth.now.time)
        self.assertAlmostEqual(self.truth.now.y, 0.0, delta=0.02)


if __name__ == "__main__":
    rostest.rosrun("racecar_description", "acceptance_track", Track)

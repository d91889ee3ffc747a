#!/usr/bin/env python3
"""image_view subscribes to the topic it is given; without a screen it says where to look."""

import os
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import Image

COMMAND = ["rosrun", "image_view", "image_view", "image:=/camera/rgb/image_raw"]
LIMIT = 60.0  # s


class ImageView(unittest.TestCase):
    def test_with_a_screen_it_subscribes(self):
        publisher = rospy.Publisher("/camera/rgb/image_raw", Image, queue_size=1)
        program = subprocess.Popen(["xvfb-run", "-a", *COMMAND], start_new_session=True)
        try:
            end = time.monotonic() + LIMIT
            while not publisher.get_num_connections() and time.monotonic() < end:
                time.sleep(0.1)
            self.assertEqual(publisher.get_num_connections(), 1)
        finally:
            os.killpg(program.pid, signal.SIGTERM)
            program.wait(LIMIT)

    def test_without_a_screen_it_says_where_to_look(self):
        screens = ("DISPLAY", "WAYLAND_DISPLAY")
        blind = {name: value for name, value in os.environ.items() if name not in screens}
        for tool in ("image_view", "stereo_view", "disparity_view"):
            done = subprocess.run(["rosrun", "image_view", tool], env=blind, text=True,
                                  capture_output=True, timeout=LIMIT, check=False)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn(f"{tool} has no window here; the page in the browser does its work, "
                          "tab Cameras.", done.stderr)


if __name__ == "__main__":
    rospy.init_node("looks_at_a_topic")
    rostest.rosrun("image_view", "looks_at_a_topic", ImageView, sys.argv)

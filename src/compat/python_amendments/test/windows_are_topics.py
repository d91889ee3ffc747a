#!/usr/bin/env python3
"""An unchanged script shows pictures; they arrive as image topics, pixel for pixel."""

import sys
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import Image

LIMIT = 60  # s
PICTURE = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)


def pixels(msg):
    return np.frombuffer(msg.data, np.uint8).reshape(msg.height, msg.width, -1)


class WindowsAreTopics(unittest.TestCase):
    def test_a_window_shown_again_and_again(self):
        msg = rospy.wait_for_message("/show_picture/windows/my_mask", Image, LIMIT)
        self.assertEqual(msg.encoding, "mono8")
        np.testing.assert_array_equal(pixels(msg)[:, :, 0], PICTURE[:, :, 0])

    def test_a_window_shown_once_reaches_who_looks_later(self):
        for _ in range(2):  # the second one subscribes after everything has been shown
            msg = rospy.wait_for_message("/show_picture/windows/still", Image, LIMIT)
            self.assertEqual(msg.encoding, "bgr8")
            np.testing.assert_array_equal(pixels(msg), PICTURE)


if __name__ == "__main__":
    rospy.init_node("windows_are_topics")
    rostest.rosrun("python_amendments", "windows_are_topics", WindowsAreTopics, sys.argv)

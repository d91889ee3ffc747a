#!/usr/bin/env python3
"""What lessons 2, 3 and 4 show, seen on the topics that stand for their windows."""

import sys
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import Image
from stand_in_camera import HEIGHT, LIMIT, WIDTH, StandInCamera


def window(topic):
    msg = rospy.wait_for_message(topic, Image, LIMIT)
    return np.frombuffer(msg.data, np.uint8).reshape(HEIGHT, WIDTH, -1)


class LessonsWindows(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.camera = StandInCamera(200)

    def test_lesson_2_shows_the_blue_channel(self):
        shown = window("/lesson_02/windows/showImage")
        self.assertEqual(shown.shape, (HEIGHT, WIDTH, 1))
        self.assertFalse(shown.any())  # yellow has no blue in it

    def test_lesson_3_shows_what_is_yellow(self):
        shown = window("/lesson_03/windows/showYellowOnly")[:, :, 0]
        self.assertEqual(np.flatnonzero(shown.all(axis=0)).tolist(), list(range(195, 206)))
        self.assertEqual(np.count_nonzero(shown), 11 * HEIGHT)
        masked = window("/lesson_03/windows/masked")
        self.assertEqual(masked[10, 200].tolist(), [0, 255, 255])
        self.assertEqual(np.count_nonzero(masked.any(axis=2)), 11 * HEIGHT)

    def test_lesson_4_marks_the_line(self):
        shown = window("/lesson_04/windows/showImage")
        self.assertEqual(shown[3 * HEIGHT // 4 + 9, 200].tolist(), [0, 0, 255])
        band = window("/lesson_04/windows/findLine")[:, :, 0]
        self.assertEqual(np.flatnonzero(band.any(axis=1)).tolist(), list(range(270, 290)))


if __name__ == "__main__":
    rospy.init_node("lessons_show_windows")
    rostest.rosrun("learning_topic", "lessons_windows", LessonsWindows, sys.argv)

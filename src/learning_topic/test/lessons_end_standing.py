#!/usr/bin/env python3
"""Ctrl-C leaves the robot standing, every time."""

import contextlib
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from roslib.packages import find_node
from stand_in_camera import LIMIT, WIDTH, StandInCamera, stands, wait_until

TIMES = 4
PERIOD = 1 / 30  # s from image to image


@contextlib.contextmanager
def running(script):
    """A lesson; killed if it still runs afterwards."""
    process = subprocess.Popen(
        find_node("learning_topic", script)[:1], stderr=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


class LessonsEnd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.camera = StandInCamera(WIDTH // 2 + 100, scale=3)  # large: callbacks take their time

    def ends_standing(self, script):
        """Drives, is ended by Ctrl-C, and has sent a stop as its last command."""
        connections = self.camera.subscriber.get_num_connections
        for attempt in range(TIMES):
            with running(script) as process:
                self.camera.next_command(lambda c: c.linear.x > 0, f"{script} driving")
                time.sleep(attempt / TIMES * PERIOD)  # at another moment between two images
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=LIMIT)
            wait_until(lambda: connections() == 0, "the last command's arrival")
            self.assertTrue(stands(self.camera.commands[-1]), f"{script}, attempt {attempt + 1}")

    def test_lesson_5_ends_standing(self):
        self.ends_standing("05follower_proporation.py")

    def test_lesson_6_ends_standing(self):
        self.ends_standing("06follower_pid.py")

    def test_lesson_7_ends_standing(self):
        self.ends_standing("07follower_ground.py")


if __name__ == "__main__":
    rospy.init_node("lessons_end_standing")
    rostest.rosrun("learning_topic", "lessons_end", LessonsEnd, sys.argv)

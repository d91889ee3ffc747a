#!/usr/bin/env python3
"""A joystick that comes after its node, is moved, unplugged and plugged in again."""

import os
import sys
import threading
import unittest

import rospy
import rostest
from joy.events import AXIS, BUTTON, EVENT
from sensor_msgs.msg import Joy

LIMIT = 60.0  # s, for whatever is waited for


class PlugIn(unittest.TestCase):
    def setUp(self):
        self.device = rospy.get_param("/joy_node/dev")
        self.changed, self.last, self.count = threading.Condition(), None, 0
        rospy.Subscriber("/joy", Joy, self.on_joy)

    def tearDown(self):
        if os.path.exists(self.device):
            os.unlink(self.device)

    def on_joy(self, message):
        with self.changed:
            self.last, self.count = message, self.count + 1
            self.changed.notify_all()

    def wait_for(self, condition, what):
        with self.changed:
            self.assertTrue(self.changed.wait_for(
                lambda: self.last is not None and condition(self.last), LIMIT), what)

    def test_it_is_opened_when_it_comes_and_when_it_comes_back(self):
        os.mkfifo(self.device)
        with open(self.device, "wb", buffering=0) as pipe:  # waits for the node to open it
            pipe.write(EVENT.pack(0, -32767, AXIS, 1) + EVENT.pack(0, 1, BUTTON, 2))
            self.wait_for(lambda m: list(m.axes) == [0, 1] and list(m.buttons) == [0, 0, 1], "joy")
            self.assertEqual(self.last.header.frame_id, self.device)
            many = self.count + 10
            self.wait_for(lambda _: self.count > many, "repeated without an event")
        os.unlink(self.device)
        os.mkfifo(self.device)
        with open(self.device, "wb", buffering=0) as pipe:
            pipe.write(EVENT.pack(0, 1, BUTTON, 0))
            self.wait_for(lambda m: list(m.axes) == [] and list(m.buttons) == [1], "joy again")


if __name__ == "__main__":
    rospy.init_node("plug_in")
    rostest.rosrun("joy", "plug_in", PlugIn, sys.argv)

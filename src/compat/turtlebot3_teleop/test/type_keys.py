#!/usr/bin/env python3
"""Types keys into the node through a pseudo-terminal and reads what the robot is told."""

import fcntl
import os
import pty
import select
import signal
import subprocess
import sys
import termios
import threading
import time
import unittest
from itertools import pairwise

import rospy
import rostest
from geometry_msgs.msg import Twist
from roslib.packages import find_node

NODE = (find_node("turtlebot3_teleop", "turtlebot3_teleop_key")[0],)
LIMIT = 60.0  # s, for whatever is waited for


def take_terminal():
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class TypeKeys(unittest.TestCase):
    def setUp(self):
        self.sent, self.arrived = [], threading.Condition()
        self.subscriber = rospy.Subscriber("/cmd_vel", Twist, self.keep, queue_size=100)
        self.keyboard, self.terminal = pty.openpty()
        self.before = termios.tcgetattr(self.terminal)
        self.shown = ""
        self.node = subprocess.Popen(NODE, stdin=self.terminal, stdout=self.terminal,
                                     stderr=subprocess.STDOUT, start_new_session=True,
                                     preexec_fn=take_terminal)

    def tearDown(self):
        if self.node.poll() is None:
            os.killpg(self.node.pid, signal.SIGKILL)
        self.node.wait()
        self.subscriber.unregister()
        os.close(self.keyboard)
        os.close(self.terminal)

    def keep(self, message):
        with self.arrived:
            self.sent.append((message.linear.x, message.angular.z))
            self.arrived.notify_all()

    def type(self, keys):
        os.write(self.keyboard, keys.encode())

    def wait_until_sent(self, wanted):
        with self.arrived:
            came = self.arrived.wait_for(lambda: self.sent and self.sent[-1] == wanted, LIMIT)
        self.assertTrue(came, f"{wanted} was not sent; the last was {self.sent[-1:]}")

    def wait_until_shown(self, text):
        end = time.monotonic() + LIMIT
        while text not in self.shown and time.monotonic() < end:
            if select.select([self.keyboard], [], [], 0.1)[0]:
                self.shown += os.read(self.keyboard, 4096).decode()
        self.assertIn(text, self.shown)

    def assert_ended_with_zero(self):
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.wait_until_sent((0.0, 0.0))
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)

    def test_keys_drive_smoothly_and_stop(self):
        self.wait_until_sent((0.0, 0.0))
        self.wait_until_shown("w / x")
        self.type("wwaaa")
        self.wait_until_sent((0.02, 0.3))
        steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(self.sent)]
        self.assertLessEqual(max(linear for linear, _ in steps), 0.005 + 1e-9)
        self.assertLessEqual(max(angular for _, angular in steps), 0.05 + 1e-9)
        self.wait_until_shown("currently:\tlinear velocity 0.02 m/s\tangular velocity 0.3 rad/s")
        self.type("s")
        self.wait_until_sent((0.0, 0.0))
        self.type("\x03")
        self.assert_ended_with_zero()

    def test_burger_limit_then_killed_politely(self):
        self.wait_until_sent((0.0, 0.0))
        self.type("w" * 30)
        self.wait_until_sent((0.22, 0.0))
        os.killpg(self.node.pid, signal.SIGTERM)
        self.assert_ended_with_zero()

    def test_closed_window_stops_the_robot(self):
        self.wait_until_sent((0.0, 0.0))
        self.type("w")
        self.wait_until_sent((0.01, 0.0))
        os.killpg(self.node.pid, signal.SIGHUP)
        self.assert_ended_with_zero()

    def test_without_terminal_one_line_and_exit_code_1(self):
        done = subprocess.run(NODE, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=LIMIT, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("terminal", done.stderr)


if __name__ == "__main__":
    rospy.init_node("type_keys")
    rostest.rosrun("turtlebot3_teleop", "type_keys", TypeKeys, sys.argv)

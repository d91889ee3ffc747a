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

import rospy
import rostest
from geometry_msgs.msg import Twist, TwistStamped
from roslib.packages import find_node

NODE = (find_node("teleop_twist_keyboard", "teleop_twist_keyboard.py")[0],)
LIMIT = 60.0  # s, for whatever is waited for


def take_terminal():
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class Keyboard(unittest.TestCase):
    def setUp(self):
        self.sent, self.arrived, self.shown = [], threading.Condition(), ""
        self.keyboard, self.terminal = pty.openpty()
        self.before = termios.tcgetattr(self.terminal)

    def tearDown(self):
        if self.node.poll() is None:
            os.killpg(self.node.pid, signal.SIGKILL)
        self.node.wait()
        self.subscriber.unregister()
        if rospy.has_param("/teleop_twist_keyboard"):  # they outlive the node that they were given
            rospy.delete_param("/teleop_twist_keyboard")
        os.close(self.keyboard)
        os.close(self.terminal)

    def start(self, *parameters, topic="/cmd_vel", kind=Twist):
        """Starts the node; returns once its keys count, which it says itself."""
        self.subscriber = rospy.Subscriber(topic, kind, self.keep, queue_size=100)
        self.node = subprocess.Popen((*NODE, *parameters), stdin=self.terminal,
                                     stdout=self.terminal, stderr=subprocess.STDOUT,
                                     start_new_session=True, preexec_fn=take_terminal)
        self.wait_until_shown("currently:")

    def keep(self, message):
        with self.arrived:
            self.sent.append(message)
            self.arrived.notify_all()

    def commands(self):
        twists = [getattr(message, "twist", message) for message in self.sent]
        return [(t.linear.x, t.linear.y, t.linear.z, t.angular.z) for t in twists]

    def type(self, keys):
        os.write(self.keyboard, keys.encode())

    def press(self, key, *wanted):
        """One key and the command that answers it: upstream sends one message a key."""
        before = len(self.sent)
        self.type(key)
        self.wait_for(lambda: len(self.sent) > before, f"a message for {key!r}")
        for value, number in zip(self.commands()[-1], wanted):
            self.assertAlmostEqual(value, number, places=6, msg=key)

    def wait_for(self, condition, what):
        with self.arrived:
            self.assertTrue(self.arrived.wait_for(condition, LIMIT), f"{what}: {self.commands()}")

    def wait_until_shown(self, text):
        end = time.monotonic() + LIMIT
        while text not in self.shown and time.monotonic() < end:
            if select.select([self.keyboard], [], [], 0.1)[0]:
                self.shown += os.read(self.keyboard, 4096).decode()
        self.assertIn(text, self.shown)

    def assert_ended_standing(self):
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.wait_for(lambda: self.commands()[-1] == (0, 0, 0, 0), "a stop at the end")
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)

    def test_every_move_and_ctrl_c(self):
        self.start()
        for key, move in {
            "i": (1, 0, 0, 0), "o": (1, 0, 0, -1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1),
            "u": (1, 0, 0, 1), ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1), "m": (-1, 0, 0, -1),
            "O": (1, -1, 0, 0), "I": (1, 0, 0, 0), "J": (0, 1, 0, 0), "L": (0, -1, 0, 0),
            "U": (1, 1, 0, 0), "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0), "M": (-1, 1, 0, 0),
            "t": (0, 0, 1, 0), "b": (0, 0, -1, 0), "k": (0, 0, 0, 0),
        }.items():
            x, y, z, turning = move
            self.press(key, 0.5 * x, 0.5 * y, 0.5 * z, 1.0 * turning)
        # An arrow, F1, 5 of the keypad, F5, Alt and I.
        for key in ("\x1b[A", "\x1bOP", "\x1bOu", "\x1b[15~", "\x1bi"):
            self.press("i", 0.5, 0, 0, 0)
            before = len(self.sent)
            self.press(key, 0, 0, 0, 0)
            self.assertEqual(len(self.sent), before + 1, f"one message for {key!r}")
        self.press("i", 0.5, 0, 0, 0)
        self.type("\x03")
        self.assert_ended_standing()

    def test_speeds_and_their_limits(self):
        self.start("_speed:=1.0", "_turn:=2.0", "_speed_limit:=1.15")
        self.press("u", 1.0, 0, 0, 2.0)
        for key, speed, turn in (("q", 1.1, 2.2), ("z", 0.99, 1.98), ("w", 1.089, 1.98),
                                 ("x", 0.9801, 1.98), ("e", 0.9801, 2.178), ("c", 0.9801, 1.9602)):
            self.press(key, speed, 0, 0, turn)
        self.wait_until_shown("currently:\tspeed 0.9801\tturn 1.9602 ")
        self.press("q", 1.07811, 0, 0, 2.15622)
        self.press("w", 1.15, 0, 0, 2.15622)
        self.wait_until_shown("Linear speed limit reached!")
        os.killpg(self.node.pid, signal.SIGTERM)
        self.assert_ended_standing()

    def test_repeats_and_forgets(self):
        self.start("_repeat_rate:=20.0", "_key_timeout:=2.0")
        self.type("i")
        self.wait_for(lambda: self.commands().count((0.5, 0, 0, 0)) >= 4, "a repeated command")
        self.wait_for(lambda: self.commands()[-1] == (0, 0, 0, 0), "the end of the command")
        os.killpg(self.node.pid, signal.SIGHUP)
        self.assert_ended_standing()

    def test_stamped_on_another_topic(self):
        self.start("_stamped:=true", "_frame_id:=base", "cmd_vel:=/other/cmd_vel",
                   topic="/other/cmd_vel", kind=TwistStamped)
        self.press("j", 0, 0, 0, 1.0)
        header = self.sent[-1].header
        self.assertEqual(header.frame_id, "base")
        self.assertLess(abs((rospy.Time.now() - header.stamp).to_sec()), LIMIT)

    def test_waits_for_a_subscriber_and_says_so(self):
        self.subscriber = rospy.Subscriber("/elsewhere", Twist, self.keep)
        self.node = subprocess.Popen(NODE, stdin=self.terminal, stdout=self.terminal,
                                     stderr=subprocess.STDOUT, start_new_session=True,
                                     preexec_fn=take_terminal)
        self.wait_until_shown("Waiting for subscriber to connect to /cmd_vel")
        self.type("\x03")
        self.assertEqual(self.node.wait(LIMIT), 0)

    def test_a_speed_that_is_no_number_one_line(self):
        self.subscriber = rospy.Subscriber("/elsewhere", Twist, self.keep)
        self.node = subprocess.Popen((*NODE, "_speed:=fast"), stdin=self.terminal,
                                     stdout=self.terminal, stderr=subprocess.PIPE, text=True,
                                     start_new_session=True)
        _, said = self.node.communicate(timeout=LIMIT)
        self.assertEqual((self.node.returncode, len(said.splitlines())), (1, 1), said)
        self.assertIn("_speed:=0.5", said)

    def test_without_terminal_one_line_and_exit_code_1(self):
        self.subscriber = rospy.Subscriber("/elsewhere", Twist, self.keep)
        self.node = subprocess.Popen(NODE, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                     text=True, start_new_session=True)
        _, said = self.node.communicate(timeout=LIMIT)
        self.assertEqual((self.node.returncode, len(said.splitlines())), (1, 1), said)
        self.assertIn("terminal", said)


if __name__ == "__main__":
    rospy.init_node("type_on_keyboard")
    rostest.rosrun("teleop_twist_keyboard", "keyboard", Keyboard, sys.argv)

"""turtle_teleop_key, typed at through a pseudo-terminal."""

import fcntl
import os
import pty
import signal
import subprocess
import termios
import threading
import time
import unittest

import rospy
from geometry_msgs.msg import Twist
from pond_watch import LIMIT, Topic, sends_to_us, start_node, wait_until

UP, DOWN, RIGHT, LEFT = (f"\x1b[{letter}" for letter in "ABCD")
TEXT = (
    "Reading from keyboard\r\n---------------------------\r\n"
    "Use arrow keys to move the turtle. 'q' to quit.\r\n"
)


def take_terminal():
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class TeleopStory(unittest.TestCase):
    def setUp(self):
        for name in ("/scale_linear", "/scale_angular"):
            if rospy.has_param(name):
                rospy.delete_param(name)

    def start(self, *arguments, topic="/turtle1/cmd_vel"):
        self.sent = Topic(topic, Twist)
        self.addCleanup(self.sent.subscriber.unregister)
        self.keyboard, self.terminal = pty.openpty()
        self.before, self.shown = termios.tcgetattr(self.terminal), ""
        self.node = start_node("turtle_teleop_key", *arguments, stdin=self.terminal,
                               stdout=self.terminal, stderr=subprocess.STDOUT,
                               preexec_fn=take_terminal)
        self.addCleanup(self.end)
        threading.Thread(target=self.read, daemon=True).start()
        wait_until(lambda: self.sent.subscriber.get_num_connections(), "the node's publisher")
        wait_until(lambda: sends_to_us("/teleop_turtle", topic), "the node's link to us")
        wait_until(lambda: "quit" in self.shown, "the text")
        wait_until(lambda: termios.tcgetattr(self.terminal) != self.before, "keys being read")

    def end(self):
        if self.node.poll() is None:
            os.killpg(self.node.pid, signal.SIGKILL)
        self.node.wait()
        os.close(self.terminal)  # ends the reading thread, which closes the other side

    def read(self):
        try:
            while text := os.read(self.keyboard, 4096):
                self.shown += text.decode(errors="replace")
        except OSError:
            pass
        os.close(self.keyboard)

    def type(self, keys):
        os.write(self.keyboard, keys.encode())

    def moves(self):
        return [(message.linear.x, message.angular.z) for message in self.sent.messages]

    def type_and_wait(self, keys, number):
        """Key by key: the topic keeps only the last message, as upstream's does."""
        self.sent.forget()
        for i, key in enumerate(keys):
            self.type(key)
            if i < number:
                wait_until(lambda wanted=i + 1: len(self.moves()) >= wanted, f"a move by {key!r}")
        return self.moves()

    def assert_ended(self):
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)

    def test_text_arrows_and_q(self):
        self.start()
        self.assertTrue(self.shown.startswith(TEXT), self.shown)
        self.assertEqual(self.type_and_wait([UP, DOWN, LEFT, RIGHT], 4),
                         [(2, 0), (-2, 0), (0, 2), (0, -2)])
        self.type("q")
        self.assert_ended()
        self.assertEqual(self.shown, TEXT)

    def test_one_message_a_key_and_none_without(self):
        self.start()
        self.type_and_wait(["wgx5A", UP], 0)
        wait_until(self.moves, "the arrow's move")
        time.sleep(0.5)  # longer than any repetition would take
        self.assertEqual(self.moves(), [(2, 0)])

    def test_scales_beside_the_node_and_another_turtle(self):
        rospy.set_param("/scale_linear", 0.5)
        rospy.set_param("/scale_angular", 3)
        self.start("turtle1/cmd_vel:=turtle2/cmd_vel", topic="/turtle2/cmd_vel")
        self.assertEqual(self.type_and_wait([UP, LEFT], 2), [(0.5, 0), (0, 3)])

    def test_ctrl_c_restores_the_terminal(self):
        self.start()
        self.type("\x03")
        self.assert_ended()
        self.assertNotIn("Traceback", self.shown)

    def test_a_closed_terminal_ends_it(self):
        self.start()
        os.killpg(self.node.pid, signal.SIGHUP)
        self.assert_ended()

    def assert_one_line(self, text, **options):
        done = subprocess.run(["rosrun", "turtlesim", "turtle_teleop_key"], text=True,
                              timeout=LIMIT, check=False, capture_output=True, **options)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(text, done.stderr)

    def test_without_a_terminal_one_line(self):
        self.assert_one_line("no terminal to read keys from", stdin=subprocess.DEVNULL)

    def test_a_scale_that_is_no_number_is_one_line(self):
        rospy.set_param("/scale_linear", "fast")
        keyboard, terminal = pty.openpty()
        self.addCleanup(os.close, keyboard)
        self.addCleanup(os.close, terminal)
        self.assert_one_line("/scale_linear must be a number, not 'fast'", stdin=terminal)

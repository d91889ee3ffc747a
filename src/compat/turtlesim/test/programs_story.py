#!/usr/bin/env python3
"""Programs that the tests start: the keys, typed at through a pseudo-terminal, and the window."""

import fcntl
import os
import pty
import signal
import subprocess
import sys
import termios
import threading
import time
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Twist
from pond_watch import LIMIT, Topic, sends_to_us, service_names, start_node, wait_until
from std_srvs.srv import Empty
from turtlesim.srv import SetPen, TeleportAbsolute

UP, DOWN, RIGHT, LEFT = (f"\x1b[{letter}" for letter in "ABCD")
TEXT = (
    "Reading from keyboard\r\n---------------------------\r\n"
    "Use arrow keys to move the turtle. 'q' to quit.\r\n"
)


def take_terminal():
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class TeleopStory(unittest.TestCase):
    """turtle_teleop_key, typed at through a pseudo-terminal."""

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
        # Not the very command that was typed.
        self.assert_one_line("without <, | or & beside it; or without keys: rostopic pub -1",
                             stdin=subprocess.DEVNULL)

    def test_a_scale_that_is_no_number_is_one_line(self):
        rospy.set_param("/scale_linear", "fast")
        keyboard, terminal = pty.openpty()
        self.addCleanup(os.close, keyboard)
        self.addCleanup(os.close, terminal)
        self.assert_one_line("/scale_linear must be a number, not 'fast'", stdin=terminal)


BACKGROUND = (69, 86, 255)


def start_screen():
    """Xvfb on a free display; returns it and the display's name."""
    reader, writer = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
        pass_fds=[writer], stderr=subprocess.DEVNULL,
    )
    os.close(writer)
    with os.fdopen(reader) as answer:
        return screen, f":{answer.readline().strip()}"


def xdotool(*arguments):
    done = subprocess.run(["xdotool", *arguments], capture_output=True, text=True, timeout=LIMIT)
    return done.stdout.strip()


def seen():
    """(500, 500, 3) RGB: the screen's upper left corner, where the window is without a manager."""
    grab = ["ffmpeg", "-loglevel", "error", "-f", "x11grab", "-draw_mouse", "0", "-video_size",
            "500x500", "-i", os.environ["DISPLAY"], "-frames:v", "1", "-f", "rawvideo",
            "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(grab, capture_output=True, timeout=LIMIT, check=True)
    return np.frombuffer(done.stdout, np.uint8).reshape(500, 500, 3)


class WindowStory(unittest.TestCase):
    """The window under Xvfb: its title, size and pixels, and what ends it."""

    @classmethod
    def setUpClass(cls):
        cls.screen, os.environ["DISPLAY"] = start_screen()

    @classmethod
    def tearDownClass(cls):
        cls.screen.terminate()
        cls.screen.wait()

    def setUp(self):
        self.node = start_node("turtlesim_node", stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        self.window = wait_until(lambda: xdotool("search", "--name", "^TurtleSim$"), "a window")
        wait_until(lambda: "/kill" in service_names(), "the node's services")

    def end(self):
        if self.node.poll() is None:
            os.killpg(self.node.pid, signal.SIGINT)
        self.node.wait(LIMIT)
        self.node.stderr.close()
        wait_until(lambda: "/kill" not in service_names(), "the end of the node")

    def assert_seen(self, row, column, color):
        wait_until(lambda: tuple(seen()[row, column]) == color, f"{color} at {row}, {column}")

    def test_size_picture_and_changes(self):
        self.assertIn("Geometry: 500x500", xdotool("getwindowgeometry", self.window))
        self.assert_seen(2, 2, BACKGROUND)
        self.assertGreater(np.ptp(seen()[225:275, 225:275], axis=(0, 1)).max(), 30)
        rospy.ServiceProxy("/turtle1/set_pen", SetPen)(255, 0, 0, 9, 0)
        jump = rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)
        jump(1, 1, 0)
        jump(10, 10, 0)
        self.assert_seen(252, 247, (255, 0, 0))
        rospy.set_param("/turtlesim/background_r", 150)
        rospy.ServiceProxy("/clear", Empty)()
        self.assert_seen(252, 247, (150, 86, 255))

    def test_there_is_no_image_topic_beside_a_window(self):
        published = [name for name, _ in rosgraph.Master("/x").getSystemState()[0]]
        self.assertNotIn("/turtlesim/image", published)

    def test_closing_the_window_ends_the_node(self):
        xdotool("windowclose", self.window)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(self.node.stderr.read(), "")

    def test_ctrl_c_ends_the_node(self):
        os.killpg(self.node.pid, signal.SIGINT)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(self.node.stderr.read(), "")


if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("turtlesim", "programs", "__main__", sys.argv)

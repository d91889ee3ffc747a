#!/usr/bin/env python3
"""Programs that the tests start, one class after another: the keyboard, settings of all nodes."""

import contextlib
import fcntl
import os
import pty
import signal
import subprocess
import sys
import tempfile
import termios
import threading
import time
import unittest
from pathlib import Path

import rospkg
import rospy
import rostest
import yaml
from dynamic_reconfigure.client import Client
from fake_controllers import LIMIT, wait_until
from keyboard import NODE, Sent, end_node, start_node
from roslib.packages import find_node

STANDING = (0.0, 0.0)
# s without a character; the node takes 0.7 s after the first and 0.25 s later for a release.
FIRST_PAUSE, PAUSE = 0.5, 0.15


def take_terminal():
    """Makes stdin the terminal of the new session, so that a typed Ctrl-C interrupts it."""
    fcntl.ioctl(0, termios.TIOCSCTTY, 0)


class KeyboardTerminal(unittest.TestCase):
    """keyboard_control.py --terminal, typed at through a pseudo-terminal."""

    @classmethod
    def setUpClass(cls):
        cls.sent = Sent()

    def setUp(self):
        self.keyboard, self.terminal = pty.openpty()
        self.before = termios.tcgetattr(self.terminal)
        self.node = start_node(
            "--terminal", stdin=self.terminal, stdout=self.terminal, stderr=subprocess.PIPE,
            text=True, preexec_fn=take_terminal,
        )
        self.shown = ""
        threading.Thread(target=self.read, daemon=True).start()
        wait_until(self.sent.subscriber.get_num_connections, "the node's publisher")
        wait_until(lambda: "the car stands" in self.shown, "keys being read")
        self.sent.forget()

    def tearDown(self):
        end_node(self.node)
        self.node.stderr.close()
        connected = self.sent.subscriber.get_num_connections
        wait_until(lambda: not connected(), "the end of the node's publisher")
        os.close(self.terminal)  # ends the reading thread, which closes the other side

    def read(self):
        try:
            while text := os.read(self.keyboard, 4096):
                self.shown += text.decode(errors="replace")
        except OSError:
            pass
        os.close(self.keyboard)

    def type(self, keys):
        self.typed = time.monotonic()
        os.write(self.keyboard, keys.encode())

    def type_repeatedly(self, first, key, seconds):
        """As a terminal whose key is held: again and again, 25 times a second. Begins anew where
        a busy machine makes a pause that means a release."""
        while not self.is_held(first, key, seconds):
            self.sent.wait_for(STANDING)
            self.sent.wait_for_silence()
            self.sent.forget()

    def is_held(self, first, key, seconds):
        self.type(first)
        self.sent.wait_for((2.0, 0.0))
        end, pause = time.monotonic() + seconds, FIRST_PAUSE
        while time.monotonic() < end:
            if time.monotonic() - self.typed > pause:
                return False
            self.type(key)
            pause = PAUSE
            time.sleep(0.04)
        return time.monotonic() - self.typed < PAUSE

    def assert_ended(self):
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)
        self.assertEqual(self.node.stderr.read(), "")

    def test_a_held_key_drives_and_the_end_of_its_characters_stops(self):
        self.type_repeatedly("w", "w", 1.5)
        self.assertEqual(set(self.sent.commands), {(2.0, 0.0)})
        self.assertGreater(len(self.sent.commands), 8)
        self.sent.wait_for(STANDING)
        self.sent.wait_for_silence()
        wait_until(lambda: "+2.00 m/s" in self.shown, "the speed shown")

    def test_a_second_key_steers_beside_the_first(self):
        self.type_repeatedly("w", "a", 1.0)
        self.assertEqual(self.sent.commands[-1], (2.0, 0.34))
        self.sent.wait_for(STANDING)

    def test_arrows_drive_and_space_stops(self):
        self.type("\x1bOq")  # 1 of the keypad, which is no Q
        self.type("\x1b[B")
        self.sent.wait_for((-2.0, 0.0))
        self.type("\x1b[C")
        self.sent.wait_for((-2.0, -0.34))
        self.type(" ")
        self.sent.wait_for(STANDING)

    def test_q_restores_the_terminal(self):
        self.type("w")
        self.sent.wait_for((2.0, 0.0))
        self.type("q")
        self.assert_ended()
        self.sent.wait_for(STANDING)

    def test_ctrl_c_stops_and_restores_the_terminal(self):
        self.type("w")
        self.sent.wait_for((2.0, 0.0))
        self.type("\x03")
        self.assert_ended()
        self.sent.wait_for(STANDING)

    def test_a_closed_terminal_stops_the_car(self):
        self.type("w")
        self.sent.wait_for((2.0, 0.0))
        os.killpg(self.node.pid, signal.SIGHUP)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.sent.wait_for(STANDING)

    def test_without_a_terminal_one_line(self):
        done = subprocess.run([*NODE, "--terminal"], stdin=subprocess.DEVNULL, text=True,
                              capture_output=True, timeout=LIMIT, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("no terminal to read keys from. Type it in a terminal,", done.stderr)
        self.assertNotIn("--terminal", done.stderr)  # the very command that was typed


FOLLOWER = "/lane_follow"


@contextlib.contextmanager
def sliders():
    """The node's settings as rqt_reconfigure has them."""
    client = Client(FOLLOWER, timeout=LIMIT)
    try:
        yield client
    finally:
        client.close()


def settings_now():
    with sliders() as client:
        return client.get_configuration(LIMIT)


class SettingsRuns(unittest.TestCase):
    """Two runs of a node on one master: what was set for the first one is gone in the second."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name, "mine.yaml")
        shipped = Path(rospkg.RosPack().get_path("car_control"), "config", "lane_follow.yaml")
        self.table = yaml.safe_load(shipped.read_text(encoding="utf-8"))
        rospy.set_param(FOLLOWER, {"ki": 0.7})  # the user's own, for every run

    def run_node(self, *arguments, **changes):
        """Start the node with these changes in its file."""
        self.file.write_text(yaml.safe_dump({**self.table, **changes}), encoding="utf-8")
        process = subprocess.Popen(
            (find_node("car_control", "lane_follow.py")[0], f"_config:={self.file}", *arguments)
        )
        self.addCleanup(process.wait, LIMIT)
        self.addCleanup(process.kill)
        return process

    def second_run_after(self, ending):
        first = self.run_node("_kp:=2.5", max_speed=1.9)
        before = settings_now()
        self.assertEqual((before["kp"], before["ki"], before["max_speed"]), (2.5, 0.7, 1.9))
        with sliders() as client:
            client.update_configuration({"kd": 0.25})
        self.assertEqual(settings_now()["kd"], 0.25)
        first.send_signal(ending)
        first.wait(LIMIT)
        self.assertEqual(rospy.get_param(FOLLOWER), {"ki": 0.7})
        self.run_node(max_speed=1.1)
        after = settings_now()
        for name, value in (("kp", self.table["kp"]), ("ki", 0.7), ("kd", self.table["kd"]),
                            ("max_speed", 1.1)):
            self.assertEqual(after[name], value, name)

    def test_nothing_stays_after_ctrl_c(self):
        self.second_run_after(signal.SIGINT)

    def test_nothing_stays_after_a_kill(self):
        self.second_run_after(signal.SIGKILL)


if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("car_control", "programs", "__main__", sys.argv)

#!/usr/bin/env python3
"""breakpoint() in the callback of lesson 5, typed at in a terminal; the course is in lockstep."""

import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import termios
import time
import unittest
from pathlib import Path

import rospy
import rostest
from gazebo_msgs.srv import GetModelState, GetWorldProperties
from roslib.packages import find_resource

LIMIT = 60.0  # s, wall
FRAME_PERIOD = 1 / 30  # s
END_LIMIT = 6.0  # s, wall, from Ctrl-C or Ctrl-D to the end
PROMPT = "(Pdb) "
CALLBACK = "    def image_callback(self, msg):\n"
CODES = re.compile(r"\x1b\[[?\d;]*[a-zA-Z]")  # colours, bracketed paste


class Terminal:
    """A program with a terminal of its own."""

    def __init__(self, *command):
        self.text = ""
        self.process, self._keys = pty.fork()
        if self.process == 0:
            os.execvpe(command[0], command, os.environ | {"TERM": "dumb", "LANGUAGE": "en"})
        self.code = None

    def read(self):
        if select.select([self._keys], [], [], 0.05)[0]:
            try:
                self.text += CODES.sub("", os.read(self._keys, 65536).decode(errors="replace"))
            except OSError:  # the program has ended
                pass

    def wait_for(self, text, times=1):
        """What came up to a text that is there so many times."""
        until = time.monotonic() + LIMIT
        while self.text.count(text) < times:
            self.read()
            assert time.monotonic() < until, f"no {text!r} ({times}) in:\n{self.text}"
        return self.text

    def type(self, keys):
        """Press keys; returns what the program answers up to its next prompt."""
        begin, prompts = len(self.text), self.text.count(PROMPT)
        os.write(self._keys, keys.encode())
        return self.wait_for(PROMPT, prompts + 1)[begin:]

    def end(self, keys):
        """Press keys that end it; returns the seconds that it took."""
        began = time.monotonic()
        os.write(self._keys, keys.encode())
        while self.code is None and time.monotonic() < began + LIMIT:
            self.read()
            found, status = os.waitpid(self.process, os.WNOHANG)
            if found:
                self.code = os.waitstatus_to_exitcode(status)
        return time.monotonic() - began

    def settings(self):
        """Whether lines are edited and shown, as in a shell."""
        local = termios.tcgetattr(self._keys)[3]
        return bool(local & termios.ICANON), bool(local & termios.ECHO)

    def close(self):
        if self.code is None:
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)
        os.close(self._keys)


def wait_until(condition, what):
    until = time.monotonic() + LIMIT
    while not condition():
        assert time.monotonic() < until, what
        time.sleep(0.02)


class Breakpoints(unittest.TestCase):
    def setUp(self):
        for service in ("get_world_properties", "get_model_state"):
            rospy.wait_for_service(f"/gazebo/{service}", LIMIT)
        self.world = rospy.ServiceProxy("/gazebo/get_world_properties", GetWorldProperties)
        self.model = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)
        wait_until(lambda: "turtlebot3_waffle" in self.world().model_names, "the car")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        lesson = find_resource("learning_topic", "05follower_proporation.py")[0]
        text = Path(lesson).read_text(encoding="utf-8")
        self.assertEqual(text.count(CALLBACK), 1)
        self.lesson = Path(folder.name, "05follower_proporation.py")
        self.lesson.write_text(text.replace(CALLBACK, CALLBACK + "        breakpoint()\n"))

    def open(self):
        terminal = Terminal(sys.executable, str(self.lesson))
        self.addCleanup(terminal.close)
        terminal.wait_for(PROMPT)
        return terminal

    def stand_still(self):
        """The time and the place at which the world stands."""
        first, pose = self.world().sim_time, self.model("turtlebot3_waffle", "").pose
        for _ in range(40):  # 2 s
            self.assertEqual(self.world().sim_time, first)
            time.sleep(0.05)
        self.assertEqual(self.model("turtlebot3_waffle", "").pose, pose)
        return first

    def check_end(self, terminal, keys):
        took = terminal.end(keys)
        self.assertEqual(terminal.code, 0, terminal.text)
        self.assertLess(took, END_LIMIT)
        self.assertNotIn("Traceback", terminal.text)
        self.assertNotIn("BdbQuit", terminal.text)
        self.assertEqual(terminal.settings(), (True, True))
        wait_until(lambda: abs(self.model("turtlebot3_waffle", "").twist.linear.x) < 0.01,
                   "the car stands")

    def test_the_world_waits_at_each_image_and_ctrl_d_ends_the_lesson(self):
        terminal = self.open()
        self.assertIn("image = self.bridge.imgmsg_to_cv2(msg", terminal.text)
        stood = self.stand_still()
        stamp = terminal.type("p msg.header.stamp.to_sec()\n")
        shown = re.search(r"^\d+\.\d+", stamp, re.MULTILINE)
        self.assertAlmostEqual(float(shown[0]), stood, delta=0.01, msg=stamp)
        terminal.type("n\n")
        self.assertIn("(180, 320, 3)", terminal.type("p image.shape\n"))
        self.assertIn("image_callback", terminal.type("c\n"))  # the next image
        self.assertAlmostEqual(self.stand_still(), stood + FRAME_PERIOD, delta=0.0015)
        self.check_end(terminal, "\x04")

    def test_ctrl_c_at_the_prompt_ends_the_lesson(self):
        terminal = self.open()
        self.stand_still()
        self.check_end(terminal, "\x03")

    def test_without_a_terminal_it_is_said_once_and_the_lesson_drives(self):
        process = subprocess.Popen(
            [sys.executable, str(self.lesson)], stdin=subprocess.DEVNULL, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(process.kill)
        wait_until(lambda: self.model("turtlebot3_waffle", "").twist.linear.x > 0.1, "it drives")
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=LIMIT)[0]
        self.assertEqual(said.count("breakpoint() is passed over"), 1, said)
        self.assertIn("05follower_proporation.py:", said)


if __name__ == "__main__":
    rospy.init_node("breakpoints_in_a_terminal", disable_rostime=True)
    rostest.rosrun("learning_topic", "breakpoints", Breakpoints)

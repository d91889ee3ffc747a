#!/usr/bin/env python3
"""gzserver as a process: it ends when told to, paused or not, and says why it cannot begin."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import rospy
import rostest
from roslib.packages import find_node

START_LIMIT = 60.0  # s, wall
END_LIMIT = 3.0  # s, wall; what a person waits after Ctrl-C
RUN_LIMIT = 60.0  # s, wall, for what ends by itself


class Ending(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, *arguments, **environment):
        self.log = os.path.join(self.folder, "log.txt")
        with open(self.log, "wb") as log:
            process = subprocess.Popen(
                [find_node("gazebo_ros", "gzserver")[0], *arguments, "__name:=ending_gazebo"],
                stdout=log, stderr=subprocess.STDOUT, env=os.environ | environment)
        self.addCleanup(process.kill)
        return process

    def output(self):
        with open(self.log, encoding="utf-8") as log:
            return log.read()

    def assert_ends(self, process, code):
        began = time.monotonic()
        self.assertEqual(process.wait(END_LIMIT), code, self.output())
        self.assertNotIn("Traceback", self.output())
        return time.monotonic() - began

    def test_signals_end_it_running_and_paused(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            for options in ((), ("-u",)):
                process = self.start(*options)
                rospy.wait_for_service("/ending_gazebo/unpause_physics", START_LIMIT)
                process.send_signal(number)
                self.assert_ends(process, 0)

    def test_it_ends_after_so_many_steps_wherever_time_began(self):
        # conforms: gzserver/--iters, gzserver/--initial_sim_time
        process = self.start("--iters", "100", "--initial_sim_time", "5")
        self.assertEqual(process.wait(RUN_LIMIT), 0, self.output())

    def test_a_world_that_cannot_be_opened_is_one_line_and_exit_code_1(self):
        broken = os.path.join(self.folder, "broken.world")
        with open(broken, "w", encoding="utf-8") as file:
            file.write("<sdf version='1.4'><world")
        for world, reason in (("no_such.world", "not found"), (broken, "not well-formed")):
            process = self.start(world)
            self.assertEqual(process.wait(RUN_LIMIT), 1)
            lines = self.output().strip().splitlines()
            self.assertEqual(len(lines), 1, lines)
            self.assertIn(world, lines[0])
            self.assertIn(reason, lines[0])

    def test_without_opengl_a_world_with_a_camera_is_one_line_and_exit_code_1(self):
        world = os.path.join(os.path.dirname(os.path.abspath(__file__)), "camera_robot.world")
        process = self.start(world, GLCONTEXT_LINUX_LIBGL="/nowhere/libGL.so")
        self.assertEqual(process.wait(RUN_LIMIT), 1)
        lines = [line for line in self.output().splitlines() if "[FATAL]" in line]
        self.assertEqual(len(lines), 1, self.output())
        for said in ("/nowhere/libGL.so", "sudo apt-get install libegl1"):
            self.assertIn(said, lines[0])

    def test_a_time_to_start_at_that_is_none(self):
        process = self.start("--initial_sim_time", "-5")
        self.assertEqual(process.wait(RUN_LIMIT), 2)
        self.assertIn("'-5' is not a number, 0 to", self.output())


if __name__ == "__main__":
    rospy.init_node("ending_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "ending", Ending)

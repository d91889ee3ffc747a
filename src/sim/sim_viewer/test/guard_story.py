#!/usr/bin/env python3
"""The robot stops when the page's server is killed, halted, or busy with something huge."""

import os
import signal
import socket
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from ackermann_msgs.msg import AckermannDriveStamped
from background import wait_until
from node_process import process_of, processor_time
from page_link import PageLink
from roslib.packages import find_node

STOPPED_WITHIN = 0.5  # s; 0.3 is promised, the rest is for a busy machine
QUIET = 0.6  # s in which nothing may come after the zero
PERIOD = 0.1  # s between messages of a held key
MOST_WORK = 0.15  # s of a processor until one is taken; with more a held key would stutter
MAPS = """
import rospy
from nav_msgs.msg import OccupancyGrid
rospy.init_node("maps", disable_rostime=True)
grid = OccupancyGrid(data=bytes(4000 * 4000))
publisher = rospy.Publisher("map", OccupancyGrid, queue_size=1)
while not rospy.is_shutdown():
    publisher.publish(grid)
    rospy.rostime.wallsleep(0.3)
"""


class Server:
    """A page's server that a test may kill, with one page."""

    def __init__(self, name):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.name = f"/{name}"
        self.process = subprocess.Popen(
            [sys.executable, find_node("sim_viewer", "sim_viewer")[0], f"__name:={name}",
             f"_port:={port}", "_control:=true"], start_new_session=True)
        self.link = PageLink(
            wait_until(lambda: rospy.get_param(f"{self.name}/url", ""), "the page's address"))

    def guard(self):
        """Number of the process that drives."""
        return process_of(f"{self.name}_drive")

    def press(self):
        """One message of a held key; the guard has taken it. Returns s that the server worked."""
        before = processor_time(self.process.pid)
        answer = self.link.ask("drive", linear=0.1, angular=0.0)
        assert answer["ok"], answer
        return processor_time(self.process.pid) - before

    def close(self):
        self.process.kill()
        self.process.wait()


class Guarding(unittest.TestCase):
    def setUp(self):
        self.heard = []  # (time, linear), s by the guard's clock, when it published that
        wheels = rospy.Subscriber("cmd_vel", AckermannDriveStamped, self.hear)
        self.addCleanup(wheels.unregister)
        self.server = Server(self.id().rpartition(".")[2])
        self.addCleanup(self.server.close)
        answer = self.server.link.ask("drive_open")
        self.assertTrue(answer["ok"], answer)
        wait_until(wheels.get_num_connections, "the guard's connection")

    def hear(self, command):
        self.heard.append((command.header.stamp.to_sec(), command.drive.speed))

    def hold(self, seconds):
        """A held key; the time of its last command, by the guard's clock."""
        for _ in range(round(seconds / PERIOD)):
            rospy.rostime.wallsleep(PERIOD)
            pressed = time.time()
            self.assertLess(self.server.press(), MOST_WORK, "the server is busy")
        return wait_until(lambda: [moment for moment, speed in self.heard
                                   if speed and moment > pressed], "the last command")[0]

    def assert_stopped(self, last, what):
        """After the last command comes one zero in time, and nothing more."""
        wait_until(lambda: self.heard[-1][1] == 0, f"a stop: {what}")
        rospy.rostime.wallsleep(QUIET)
        after = [(moment, speed) for moment, speed in self.heard if moment > last]
        print(f"{what}: stopped after {after[0][0] - last:.3f} s")
        self.assertEqual([speed for _, speed in after], [0], f"{what}: one zero, nothing after it")
        self.assertLess(after[0][0] - last, STOPPED_WITHIN, what)

    def test_a_killed_server(self):
        last = self.hold(0.5)
        self.server.process.kill()
        self.assert_stopped(last, "the server is killed")

    def test_a_halted_server(self):
        last = self.hold(0.5)
        self.server.process.send_signal(signal.SIGSTOP)
        self.assert_stopped(last, "the server is halted")
        self.server.process.send_signal(signal.SIGCONT)

    def test_an_interrupted_server(self):
        last = self.hold(0.5)
        os.killpg(self.server.process.pid, signal.SIGINT)
        self.assert_stopped(last, "Ctrl-C")
        self.server.process.wait(60.0)

    def test_a_server_that_reads_a_huge_map(self):
        maps = subprocess.Popen([sys.executable, "-c", MAPS])
        self.addCleanup(maps.wait)
        self.addCleanup(maps.kill)
        wait_until(lambda: "/map" in dict(rospy.get_published_topics()), "a map")
        self.assertTrue(self.server.link.ask("watch", what="echo", args={"topic": "/map"})["ok"])
        wait_until(lambda: self.server.link.events, "a map on the page")
        for _ in range(3):
            self.assert_stopped(self.hold(0.5), "a huge map is read")

    def test_a_killed_guard(self):
        self.hold(0.5)
        os.kill(self.server.guard(), signal.SIGKILL)
        wait_until(lambda: self.heard[-1][1] == 0, "a stop by the next guard")
        self.assert_stopped(self.hold(0.5), "nothing comes any more, after another guard's death")


if __name__ == "__main__":
    rospy.init_node("guard", disable_rostime=True)
    rostest.rosrun("sim_viewer", "guard", Guarding, sys.argv)

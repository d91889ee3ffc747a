#!/usr/bin/env python3
"""A second page says where the first one is, and the first one notices nothing."""

import os
import socket
import subprocess
import sys
import tempfile
import unittest
from urllib.parse import urlsplit

import rosgraph
import rospy
import rostest
from background import LIMIT, wait_until
from node_process import process_of
from roslib.packages import find_node

NODE = "/page"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class SecondPage(unittest.TestCase):
    def setUp(self):
        self.port = free_port()
        self.address = f"http://127.0.0.1:{self.port}/"
        self.environment = dict(os.environ)

    def start(self, **parameters):
        words = {"port": self.port, **parameters}
        server = subprocess.Popen(
            [sys.executable, find_node("sim_viewer", "sim_viewer")[0], f"__name:={NODE[1:]}",
             *(f"_{name}:={value}" for name, value in words.items())], start_new_session=True,
            env=self.environment, text=True, stdout=subprocess.PIPE)
        self.addCleanup(server.communicate, timeout=LIMIT)
        self.addCleanup(server.terminate)
        return server

    def start_and_wait(self):
        server = self.start()
        line = next(line for line in server.stdout if line.startswith("viewer: "))
        self.assertEqual(line, f"viewer: {self.address}\n")
        return server

    def second(self, **parameters):
        """What a second one prints until it ends, and its exit code."""
        server = self.start(**parameters)
        said, _ = server.communicate(timeout=LIMIT)
        return said, server.returncode

    def test_it_names_the_first_ones_address(self):
        first = self.start_and_wait()
        self.assertEqual(self.second(), (f"A page runs already: {self.address}\n", 0))
        self.assertEqual(self.second(port=free_port()),
                         (f"A page runs already: {self.address}\n", 0))
        self.assertEqual((process_of(NODE), first.poll()), (first.pid, None))

    def test_what_the_first_one_lacks_is_named(self):
        first = self.start_and_wait()
        said, code = self.second(control="true", rviz="/a.rviz", address="127.0.0.1")
        self.assertEqual((said, code), (
            f"A page runs already: {self.address} It was started without control:=true "
            "rviz:=/a.rviz: end it with Ctrl-C in its terminal, then type this again.\n", 1))
        self.assertEqual((process_of(NODE), first.poll()), (first.pid, None))

    def test_one_that_was_killed_does_not_block_the_next(self):
        first = self.start_and_wait()
        first.kill()
        first.wait(LIMIT)
        self.assertTrue(rosgraph.Master("/test").lookupNode(NODE))  # still registered
        self.start_and_wait()

    def test_another_programs_page_at_the_port_is_not_ours(self):
        with socket.create_server(("127.0.0.1", self.port)):
            server = self.start()
            said, address = (next(server.stdout) for _ in range(2))
        port = urlsplit(address.split()[-1]).port  # the next one, unless that is taken as well
        self.assertGreater(port, self.port)
        self.assertEqual(said, f"viewer: port {self.port} is taken, so it is {port}\n")

    def test_the_page_of_another_master_at_the_port_is_named(self):
        first = self.start_and_wait()
        theirs = self.environment["ROS_MASTER_URI"]
        with tempfile.TemporaryDirectory() as folder:
            self.environment |= {"ROS_MASTER_URI": f"http://localhost:{free_port()}",
                                 "ROS_LOG_DIR": folder}
            self.start_master()
            second = self.start()
            said, address = (next(second.stdout) for _ in range(2))
            port = urlsplit(address.split()[-1]).port
            self.assertGreater(port, self.port)
            self.assertEqual(said, f"viewer: port {self.port} has a page that shows "
                             f"the master {theirs}, so this one is at {port}\n")
            self.assertIsNone(first.poll())
            second.terminate()  # before its master
            second.communicate(timeout=LIMIT)

    def start_master(self):
        port = self.environment["ROS_MASTER_URI"].rpartition(":")[2]
        master = subprocess.Popen(["roscore", "-p", port], env=self.environment,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(master.wait, LIMIT)
        self.addCleanup(master.terminate)
        wait_until(lambda: rosgraph.is_master_online(self.environment["ROS_MASTER_URI"]), "master")
        return master

    def test_a_page_whose_master_has_ended_is_the_next_masters_page(self):
        with tempfile.TemporaryDirectory() as folder:
            self.environment |= {"ROS_MASTER_URI": f"http://localhost:{free_port()}",
                                 "ROS_LOG_DIR": folder}
            master = self.start_master()
            first = self.start_and_wait()
            master.terminate()
            master.wait(LIMIT)
            self.start_master()
            second = self.start()
            found = rosgraph.Master("/test", self.environment["ROS_MASTER_URI"])
            wait_until(lambda: self.is_registered(found), "the page at the new master")
            wait_until(lambda: None in (first.poll(), second.poll()) and
                       first.poll() != second.poll(), "the end of one of them")
            ended, runs = sorted((first, second), key=lambda page: page.poll() is None)
            self.assertIn(f"A page runs already: {self.address}\n", ended.stdout.read())
            self.assertEqual(ended.returncode, 0)
            runs.terminate()  # before its master
            runs.communicate(timeout=LIMIT)

    def is_registered(self, master):
        try:
            return master.getParam(f"{NODE}/url") == self.address and master.lookupNode(NODE)
        except rosgraph.MasterException:
            return False


if __name__ == "__main__":
    rospy.init_node("second_page", disable_rostime=True)
    rostest.rosrun("sim_viewer", "second_page", SecondPage, sys.argv)

#!/usr/bin/env python3
"""A page that stays open sees what has changed: another server, a robot that comes later."""

import socket
import subprocess
import sys
import unittest

import rospy
import rostest
from background import wait_until
from chromium import Browser
from geometry_msgs.msg import Twist
from roslib.packages import find_node

NODE = "/page"
CHOICES = "[...document.querySelectorAll('#drive-topic option')].map((one) => one.value)"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Restarted(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.port = free_port()

    def setUp(self):
        self.server = None
        self.addCleanup(lambda: self.end_server())

    def start_server(self, **parameters):
        """On the same port each time."""
        if rospy.has_param(NODE):
            rospy.delete_param(NODE)
        words = {"port": self.port, **parameters}
        self.server = subprocess.Popen(
            [sys.executable, find_node("sim_viewer", "sim_viewer")[0], f"__name:={NODE[1:]}",
             *(f"_{name}:={value}" for name, value in words.items())], start_new_session=True)
        return wait_until(lambda: rospy.get_param(f"{NODE}/url", ""), "the page's address")

    def listen(self, topic, take=None):
        """A robot, until the test ends."""
        robot = rospy.Subscriber(topic, Twist, take)
        self.addCleanup(robot.unregister)
        return robot

    def end_server(self):
        if self.server is not None:
            self.server.terminate()
            self.server.wait(60.0)

    def test_control_counts_without_loading_the_page_by_hand(self):
        page = self.browser.open(self.start_server(control="false") + "#drive")
        page.wait_for("document.querySelector('#drive-state')?.textContent.includes('may only')")
        self.end_server()
        page.wait_for("document.querySelector('#problem').textContent != ''")
        self.start_server(control="true")
        page.wait_for("Boolean(document.querySelector('#joystick'))")
        page.close()

    def test_a_server_that_asks_for_another_token_says_so(self):
        page = self.browser.open(self.start_server())
        page.wait_for("document.querySelector('#light')?.className == 'on'")
        self.end_server()
        self.start_server(token="ours")
        page.wait_for("document.querySelector('#problem').textContent.includes('?token=')")
        page.close()

    def test_a_robot_that_comes_later_can_be_driven_and_one_that_goes_is_kept(self):
        page = self.browser.open(self.start_server(control="true") + "#drive")
        page.wait_for("Boolean(document.querySelector('#drive-topic'))")
        first = self.listen("/one/cmd_vel")
        page.wait_for(f"{CHOICES}.includes('/one/cmd_vel')")
        first.unregister()
        self.listen("/two/cmd_vel")
        page.wait_for(f"{CHOICES}.includes('/two/cmd_vel')")
        self.assertEqual(page.evaluate("document.querySelector('#drive-topic').value"),
                         "/one/cmd_vel", "another robot would drive under the same fingers")
        page.close()

    def test_a_key_right_after_a_robot_was_chosen_drives_that_robot(self):
        heard = []
        for topic in ("/left/cmd_vel", "/right/cmd_vel"):
            self.listen(topic, lambda _, topic=topic: heard.append(topic))
        page = self.browser.open(self.start_server(control="true") + "#drive")
        page.wait_for(f"{CHOICES}.includes('/right/cmd_vel')")
        page.evaluate("(select => { select.value = '/right/cmd_vel';"
                      "select.dispatchEvent(new Event('change')); })"
                      "(document.querySelector('#drive-topic'))")

        def drives():
            if page.evaluate("document.querySelector('#drive-state').dataset.state") == "stopped":
                page.key("w", False)  # a page that hung lets go, and wants it pressed again
                page.key("w", True)
            return heard.count("/right/cmd_vel") > 2

        page.key("w", True)
        wait_until(drives, "the robot that was chosen")
        page.key("w", False)
        self.assertNotIn("/left/cmd_vel", heard)
        page.close()


if __name__ == "__main__":
    rospy.init_node("restarted", disable_rostime=True)
    rostest.rosrun("sim_viewer", "restarted", Restarted, sys.argv)

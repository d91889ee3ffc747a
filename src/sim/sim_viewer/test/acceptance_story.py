#!/usr/bin/env python3
"""What the page promises, with one simulator: what it shows, and how it drives and stops."""

import sys
import time
import unittest
from urllib.parse import urlsplit

import cv2
import numpy as np
import rospy
import rostest
from background import wait_until
from chromium import Browser
from driving_story import Driving, Keys
from geometry_msgs.msg import Twist, Vector3
from nav_msgs.msg import Odometry
from page_link import PageLink
from std_srvs.srv import Empty

CAMERA = "/camera/rgb/image_raw"
PICTURES = 20
PAGES = 5
COURSE = {"yellow": ((0, 200, 200), (60, 255, 255)), "white": ((230,) * 3, (255,) * 3)}  # BGR


class Showing(unittest.TestCase):
    """It shows course, robot, pictures and all tabs, to five at once, and asks nobody else."""

    @classmethod
    def setUpClass(cls):
        rospy.wait_for_message("odom", Odometry, 60.0)
        cls.url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.addClassCleanup(rospy.ServiceProxy("/gazebo/reset_world", Empty))
        cls.page = cls.browser.open(cls.url)
        cls.page.wait_for("document.querySelectorAll('#tabs button').length >= 11")

    def open_tab(self, name):
        self.page.evaluate(f"document.querySelector('#tab-{name}').click()")

    def scene(self):
        """The 3D view without the page's frame, BGR."""
        x, y, width, height = self.page.evaluate(
            "(({x, y, width, height}) => [x, y, width, height].map(Math.round))("
            "document.querySelector('canvas').getBoundingClientRect())")
        return self.page.picture()[y:y + height, x:x + width]

    def test_the_scene_has_the_course_and_a_robot_that_moves(self):
        self.page.resize(640, 480)
        self.open_tab("scene")
        self.page.wait_for("Boolean(document.querySelector('canvas'))")
        for name, (low, high) in COURSE.items():
            wait_until(lambda low=low, high=high: cv2.inRange(self.scene(), low, high).sum() / 255
                       > 300, f"the {name} line on the course")
        before = self.scene()
        command = rospy.Publisher("cmd_vel", Twist, queue_size=1, latch=True)
        command.publish(Twist(angular=Vector3(z=1.0)))
        rospy.rostime.wallsleep(1.0)
        command.publish(Twist())  # a processor that draws takes no picture of what moves
        wait_until(lambda: self.moved_px(before) > 10, "the robot has turned in the picture")
        command.unregister()

    def moved_px(self, before):
        """Of a fourth of the width, where it does not count how finely each is drawn."""
        now, then = (cv2.resize(picture, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
                     for picture in (self.scene(), before))
        return int((cv2.absdiff(now, then).max(axis=2) > 30).sum())

    def test_what_stands_still_is_drawn_finely(self):
        self.page.resize(640, 480)
        self.open_tab("scene")
        rospy.ServiceProxy("/gazebo/pause_physics", Empty)()
        self.addCleanup(rospy.ServiceProxy("/gazebo/unpause_physics", Empty))
        self.page.wait_for("(({width, clientWidth}) => width >= clientWidth && clientWidth > 0)("
                           "document.querySelector('canvas'))")

    def test_pictures_go_on(self):
        link = PageLink(self.url)
        answer = link.ask("watch", what="image", args={"topic": CAMERA})
        self.assertTrue(answer["ok"], answer)
        began = time.monotonic()
        pictures = wait_until(lambda: self.pictures(link)[PICTURES:], "pictures")
        print(f"{PICTURES / (time.monotonic() - began):.1f} pictures/s")
        picture = cv2.imdecode(np.frombuffer(pictures[-1], np.uint8), cv2.IMREAD_COLOR)
        self.assertEqual(picture.shape, (480, 640, 3))
        self.assertGreater(cv2.inRange(picture, *COURSE["yellow"]).sum() / 255, 500)
        self.assertLess(len(pictures[-1]), 60_000)
        link.close()

    def pictures(self, link):
        return [event for event in link.events if isinstance(event, bytes)]

    def test_five_pages_at_once(self):
        links = [PageLink(self.url) for _ in range(PAGES)]
        for link in links:
            self.assertTrue(link.ask("watch", what="image", args={"topic": CAMERA})["ok"])
            self.assertTrue(link.ask("watch", what="poses")["ok"])
        for link in links:
            wait_until(lambda link=link: len(self.pictures(link)) > PICTURES, "pictures for each")
            link.close()

    def test_every_tab_opens_and_nothing_leaves_the_machine(self):
        own = urlsplit(self.url).netloc
        for name in self.page.evaluate(
                "[...document.querySelectorAll('#tabs button')].map((tab) => tab.id.slice(4))"):
            self.open_tab(name)
            self.page.wait_for("document.querySelector('#content').childElementCount > 0")
            rospy.rostime.wallsleep(0.3)
        self.assertGreater(len(self.page.requests), 10)
        asked = {urlsplit(url).netloc for url in self.page.requests
                 if not url.startswith(("data:", "blob:"))}
        self.assertEqual(asked, {own})
        self.assertEqual(self.page.errors, [])


class Suite(unittest.TestSuite):
    """The classes in this order, for rostest takes one name."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(Showing), load(Driving), load(Keys)])


if __name__ == "__main__":
    rospy.init_node("acceptance", disable_rostime=True)
    rostest.rosrun("sim_viewer", "acceptance", "acceptance_story.Suite", sys.argv)

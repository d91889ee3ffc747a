#!/usr/bin/env python3
"""Parts of the page in a browser, with what they are told made up by the test: no simulator."""

import json
import sys
import unittest

import rospy
import rostest
from background import wait_until
from chromium import Browser
from sensor_msgs.msg import LaserScan

from bullet_sim import __version__

LINK = "({ watch: (what, _, tell) => { window.told[what] = tell; return () => {}; }, call: null })"
SCENE = {"background": None, "ambient": [1, 1, 1, 1], "sky": False, "lights": [], "links": []}
HINT = "document.querySelector('#made .hint')"


class Parts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.page = cls.browser.open(url + "#topics")
        cls.page.wait_for("document.querySelectorAll('#tabs button').length >= 11")

    def test_the_page_names_its_version(self):
        self.assertEqual(self.page.evaluate("(({ textContent, title }) => [textContent, title])"
                                            "(document.getElementById('version'))"),
                         [f"v{__version__}", "version of these courses"])

    def imported(self, path, script):
        """The value of a script about `module`, a module of the page."""
        return self.page.evaluate(f"import('{path}').then((module) => {{ {script} }})")

    def test_the_robot_is_not_the_model_of_most_links(self):
        models = {"turtlebot3_autorace_2020": ["wall_1", "wall_2", "wall_3", "wall_4", "bar"],
                  "turtlebot3_burger": ["base_footprint", "wheel_left_link"], "ball": ["link"]}
        made = json.dumps([[name, [{"name": f"{name}::{link}"} for link in links]]
                           for name, links in models.items()])
        for chosen, left in (("turtlebot3_burger", made),
                             ("turtlebot3_autorace_2020", made.replace("base_", "").replace(
                                 "wheel", "part"))):
            self.assertEqual(self.imported(
                "/scene.js", f"return module.robotOf({{ models: new Map({left}) }});"), chosen)

    def test_loading_until_the_first_frame(self):
        self.imported("/scene.js", "document.body.append(Object.assign(document.createElement("
                      "'div'), { id: 'made' })); window.told = {};"
                      f"module.mount(document.querySelector('#made'), {LINK}); return 1;")
        self.assertEqual(self.page.evaluate(f"{HINT}.textContent"), "loading …")
        self.page.evaluate(f"window.told.scene({json.dumps(SCENE)}); 0")
        self.assertIn("Nothing to show yet", self.page.evaluate(f"{HINT}.textContent"))
        link = {"name": "ball::link", "model": "ball", "pose": [0, 0, 0, 0, 0, 0, 1], "plane": None,
                "parts": []}
        self.page.evaluate(f"window.told.scene({json.dumps({**SCENE, 'links': [link]})}); 0")
        self.assertEqual(self.page.evaluate(f"[{HINT}.textContent, {HINT}.hidden]"),
                         ["loading …", False])

    def test_a_picture_says_so_too(self):
        self.assertIn("loading …", self.imported(
            "/images.js", "return new module.Picture('/camera', null).card.textContent;"))

    def chosen(self, usual, topics, by_default=True):
        """The topic of a display of laser scans with this one, where there are these."""
        kind = {"class": "rviz/LaserScan", "messages": ["sensor_msgs/LaserScan"], "topic": "/scan",
                "options": []}
        display = {"class": "rviz/LaserScan", "topic": usual, "topic_is_default": by_default}
        return self.imported("/rviz/session.js", (
            "const session = new module.Session({ fixed_frame: '', view: {}, topics: {},"
            f" displays: [] }}, [{json.dumps(kind)}]); const display = {json.dumps(display)};"
            f"session.choose(display, new Map({json.dumps(list(topics.items()))}));"
            "return display.topic;"))

    def test_a_displays_default_is_a_topic_that_exists(self):
        scans = "sensor_msgs/LaserScan"
        self.assertEqual(self.chosen("/scan", {scans: ["/front", "/tb3_0/scan"]}), "/tb3_0/scan")
        self.assertEqual(self.chosen("/scan", {scans: ["/front", "/rear"]}), "/front")
        self.assertEqual(self.chosen("/scan", {scans: ["/a/scan", "/scan"]}), "/scan")
        self.assertEqual(self.chosen("/scan", {"nav_msgs/Path": ["/path"]}), "/scan")
        self.assertEqual(self.chosen("/mine", {scans: ["/front"]}, by_default=False), "/mine")

    def test_the_tab_rviz_begins_with_what_exists(self):
        publisher = rospy.Publisher("/robot_1/scan", LaserScan, queue_size=1)
        self.addCleanup(publisher.unregister)
        self.page.evaluate("document.querySelector('#tab-rviz').click()")
        self.page.wait_for("[...document.querySelectorAll('.rviz-display input.topic')].some("
                           "(one) => one.value === '/robot_1/scan')")


if __name__ == "__main__":
    rospy.init_node("parts", disable_rostime=True)
    rostest.rosrun("sim_viewer", "parts", Parts, sys.argv)

"""The tools' tabs in a browser: what they show is true, and their buttons do what they say."""

import json
import re
import shutil
import unittest
from pathlib import Path

import rosgraph
import rospy
from background import wait_until
from chromium import Browser
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image
from turtlesim.msg import Pose

POSE = "/turtle1/pose"
TABS = ("graph", "plot", "console", "topics", "services", "parameters", "bags", "tf")


class ToolsPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_message(POSE, Pose, 60.0)
        cls.folder = Path(rospy.get_param("/sim_viewer/bags").strip())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.page = cls.browser.open(cls.url)
        for tab in TABS:
            cls.page.wait_for(f"!!document.querySelector('#tab-{tab}')")

    def tearDown(self):
        self.assertEqual(self.page.errors, [])

    def open(self, tab):
        self.click(f"#tab-{tab}")

    def click(self, selector):
        self.page.wait_for(f"!!document.querySelector({json.dumps(selector)})")
        self.page.evaluate(f"document.querySelector({json.dumps(selector)}).click()")

    def fill(self, selector, text):
        self.page.evaluate(f"(box => {{box.value = {json.dumps(text)};"
                           "box.dispatchEvent(new Event('input'))})"
                           f"(document.querySelector({json.dumps(selector)}))")

    def text(self, selector):
        found = self.page.evaluate(f"document.querySelector({json.dumps(selector)})?.textContent")
        return found or ""

    def test_the_graph_says_who_drives_and_which_commands_nobody_hears(self):
        self.open("graph")
        self.page.wait_for("""
            document.querySelector('#wiring tr[data-name="/turtle1/cmd_vel"]')?.textContent
              .includes('/draw_square')""")
        self.assertEqual(self.text("#wiring-faults"), "")
        rival = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        self.addCleanup(rival.unregister)
        self.page.wait_for(f"""
            document.querySelector('#wiring-faults').textContent
              .includes({json.dumps(rospy.get_name())})""")

    def test_the_tab_drive_says_who_else_drives_the_robot_that_is_chosen(self):
        idle = rospy.Subscriber("/idle/cmd_vel", Twist, lambda _twist: None)
        self.addCleanup(idle.unregister)
        self.open("drive")
        for robot, drivers in (("/turtle1", "/draw_square sends commands here, too"), ("/idle", ""),
                               ("/turtle1", "/draw_square sends commands here, too")):
            self.page.wait_for(f"""(select => {{
                select.value = "{robot}/cmd_vel";
                if (select.value) select.dispatchEvent(new Event("change"));
                return select.value; }})(document.querySelector("#drive-topic"))""")
            self.page.wait_for(f"document.querySelector('#drive-who').textContent === '{drivers}'")

    def test_a_window_of_opencv_is_shown_beside_the_camera_when_it_appears(self):
        shown = "!!document.querySelector('figure[data-topic=\"%s\"]')"
        self.open("cameras")
        self.page.wait_for(shown % "/turtlesim/image")
        window = rospy.Publisher("/finder/windows/mask", Image, queue_size=1, latch=True)
        self.addCleanup(window.unregister)
        window.publish(Image(height=2, width=2, step=2, encoding="mono8", data=bytes(4)))
        self.page.wait_for(shown % "/finder/windows/mask")
        self.assertTrue(self.page.evaluate(shown % "/turtlesim/image"))

    def test_the_graph_is_drawn(self):
        self.open("graph")
        for source, target in (("/draw_square", "/turtle1/cmd_vel"),
                               ("/turtle1/cmd_vel", "/turtlesim")):
            self.page.wait_for(f"!!document.querySelector('.edge[data-from=\"{source}\"]"
                               f"[data-to=\"{target}\"]')")
        self.assertEqual(self.page.evaluate("""
            [...document.querySelectorAll('svg.graph g[data-name]')].filter((one) =>
              one.querySelector('text').getBBox().width > one.querySelector('rect').getBBox().width)
            .map((one) => one.dataset.name).join()"""), "")
        self.fill("#graph-filter", "cmd_vel")
        self.page.wait_for("document.querySelectorAll('#graph .topic').length === 1")
        self.fill("#graph-filter", "")

    def test_the_plot_has_the_topics_value(self):
        self.open("plot")
        self.fill("#plot-path", "/turtle1/pose/x:y")
        self.click("#plot-add")
        self.page.wait_for("document.querySelectorAll('#plot-legend output').length === 2")
        shown = '.entry[data-path="/turtle1/pose/x"] output'
        heard = []
        subscriber = rospy.Subscriber(POSE, Pose, lambda pose: heard.append(f"{pose.x:.5g}"))
        wait_until(lambda: self.text(shown) in heard, "a number that was published")
        subscriber.unregister()
        drawn = ("(c => c.getContext('2d').getImageData(0, 0, c.width, c.height).data"
                 ".some(v => v > 0))(document.querySelector('#plot-chart'))")
        self.page.wait_for(drawn)

    def test_the_console_shows_lines_as_text(self):
        self.open("console")
        self.page.evaluate("document.querySelector('#console-level').value = 'error';"
                           "document.querySelector('#console-level')"
                           ".dispatchEvent(new Event('change'))")

        def shown():
            rospy.logerr("<b>broken</b> gear 7")
            rospy.logwarn("only warned")
            return "<b>broken</b> gear 7" in self.text("#console-lines")

        wait_until(shown, "the line")
        self.assertNotIn("only warned", self.text("#console-lines"))
        self.assertFalse(self.page.evaluate("!!document.querySelector('#console-lines b')"))
        self.fill("#console-filter", "gear [0-6]")
        wait_until(lambda: "gear" not in self.text("#console-lines"), "the filter")
        self.fill("#console-filter", r"gear \d")
        wait_until(lambda: "gear 7" in self.text("#console-lines"), "the filter")

    def test_a_topic_is_echoed_and_measured(self):
        self.open("topics")
        self.click(f'#topics tr[data-name="{POSE}"]')
        wait_until(lambda: "linear_velocity:" in self.text("#echo"), "a message")
        self.click(f'#topics tr[data-name="{POSE}"] input')
        wait_until(lambda: self.text(f'#topics tr[data-name="{POSE}"] .rate').startswith("6"),
                   "about 62 Hz")

    def test_a_service_is_called(self):
        self.open("services")
        self.click('#services tr[data-name="/turtle1/teleport_absolute"]')
        self.page.wait_for("!!document.querySelector('#service-call')")
        self.fill("#service-request", "{x: 3, z: 2}")
        self.click("#service-call")
        wait_until(lambda: "no field 'z'" in self.text("#service-detail .error"), "the reason")
        self.fill("#service-request", "{x: 3, y: 2}")
        self.click("#service-call")
        wait_until(lambda: self.text("#service-response") == "{}", "an empty answer")

    def test_a_parameter_is_set(self):
        rospy.set_param("/page/gain", 1.5)
        self.open("parameters")
        self.click('#parameters [data-name="/page/gain"]')
        self.fill("#parameter-value", "[2.5, text]")
        self.click("#parameter-set")
        wait_until(lambda: rospy.get_param("/page/gain") == [2.5, "text"], "the new value")

    def records_poses(self):
        """Whether somebody does; rosbag looks for topics once a second."""
        subscribers = dict(rosgraph.Master("/tools_page").getSystemState()[1])
        return any(node.startswith("/record") for node in subscribers.get(POSE, ()))

    def recorded_seconds(self):
        found = re.search(r"page\.bag: ([\d.]+) s", self.text("#bag-recording"))
        return float(found[1]) if found else 0.0

    def test_a_bag_is_recorded(self):
        self.open("bags")
        self.page.wait_for("!!document.querySelector('#bag-name')")
        self.fill("#bag-name", "page")
        self.click("#bag-record")
        wait_until(self.records_poses, "a recorder of the poses")
        begin = self.recorded_seconds()
        wait_until(lambda: self.recorded_seconds() > begin + 1.0, "a second of recording")
        self.click("#bag-recording-stop")
        self.click('#bags tr[data-name="page.bag"]')
        wait_until(lambda: POSE in self.text("#bag-topics"), "what is in the bag")
        self.assertTrue((self.folder / "page.bag").exists())

    def test_the_tree_of_frames_is_shown(self):
        self.open("tf")
        self.click('#tf tr[data-name="camera"]')
        wait_until(lambda: "1.0000, 2.0000, 3.0000" in self.text("#tf-detail"), "its place")

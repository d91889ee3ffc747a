"""The page drives the waffle, and everything that must stop it does, within 0.3 s."""

import math
import time
import unittest

import chromium
import firefox
import rospy
from background import wait_until
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from page_link import PageLink

STOPPED_WITHIN = 0.5  # s; 0.3 is promised, the rest is for a busy machine
QUIET = 0.5  # s in which nothing may come after the zero
PERIOD = 0.1  # s between messages of a held key


class Wheel:
    """What arrives on cmd_vel: (time, linear, angular), in s of the monotonic clock."""

    def __init__(self):
        self.heard = []
        rospy.Subscriber("cmd_vel", Twist, self._hear)

    def _hear(self, twist):
        self.heard.append((time.monotonic(), twist.linear.x, twist.angular.z))

    def moving(self):
        return bool(self.heard) and any(self.heard[-1][1:])


class Keys(unittest.TestCase):
    Browser = firefox.Browser

    @classmethod
    def setUpClass(cls):
        rospy.wait_for_message("odom", Odometry, 60.0)
        cls.url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.wheel = Wheel()
        cls.browser = cls.Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.page = cls.drive_page(cls.browser)

    def setUp(self):
        self.page.key("w", False)  # what a test that failed has left down
        wait_until(lambda: not self.wheel.moving(), "a robot at rest")

    @classmethod
    def drive_page(cls, browser):
        """The tab Drive with the camera beside it: in 3D a processor that draws is too slow."""
        page = browser.open(f"{cls.url}#drive")
        page.wait_for("document.querySelector('#drive-topic')?.value == '/cmd_vel'")
        page.evaluate("(() => { const view = document.querySelector('#drive-view');"
                      "view.value = './images.js'; view.dispatchEvent(new Event('change')); })()")
        page.wait_for("document.querySelector('.drive-view img')?.naturalWidth > 0")
        return page

    def pose(self):
        return rospy.wait_for_message("odom", Odometry, 60.0).pose.pose

    def way_ahead(self, start):
        """How far it is ahead of where it stood and looked, in m."""
        now, yaw = self.pose(), 2 * math.atan2(start.orientation.z, start.orientation.w)
        return ((now.position.x - start.position.x) * math.cos(yaw)
                + (now.position.y - start.position.y) * math.sin(yaw))

    def assert_stops(self, stop, what):
        """`stop()` while the robot drives: one zero in time, and nothing more."""
        try:
            wait_until(self.wheel.moving, f"a command before: {what}")
        except AssertionError as error:
            said = self.page.evaluate("document.querySelector('#drive-state').textContent")
            raise AssertionError(f"{error}; the page says: {said}") from None
        began = time.monotonic()
        stop()
        ended = time.monotonic()  # a browser may take its time to do what it is told
        wait_until(lambda: not self.wheel.moving(), f"a stop after: {what}")
        stopped = self.wheel.heard[-1][0]
        rospy.rostime.wallsleep(QUIET)
        late = [message for message in self.wheel.heard if message[0] > began]
        zeros = [message for message in late if not any(message[1:])]
        print(f"{what}: stopped after {stopped - began:.3f} s")
        self.assertLess(stopped - ended, STOPPED_WITHIN, what)
        self.assertEqual(zeros, late[-1:], f"{what}: one zero, and nothing after it")

    def test_keys_drive_and_letting_go_stops(self):
        start = self.pose()
        self.page.key("w", True)
        wait_until(lambda: self.way_ahead(start) > 0.05, "a way")
        self.assert_stops(lambda: self.page.key("w", False), "the key comes up")
        linear, angular = self.wheel.heard[-2][1:]
        self.assertAlmostEqual(linear, 0.2)
        self.assertEqual(angular, 0.0)
        for key, command in {"ArrowLeft": (0.0, 1.0), "d": (0.0, -1.0), "s": (-0.2, 0.0)}.items():
            self.page.key(key, True)
            wait_until(lambda command=command: self.wheel.heard[-1][1:] == command,
                       f"{key} gives {command}")
            self.page.key(key, False)
            wait_until(lambda: not self.wheel.moving(), f"{key} came up")

    def test_the_sliders_set_the_speed(self):
        before = len(self.wheel.heard)
        self.page.evaluate("document.querySelector('#drive-speed').value = 0.1")
        self.page.key("w", True)
        wait_until(self.wheel.moving, "a command")
        self.page.key("w", False)
        self.page.evaluate("document.querySelector('#drive-speed').value = 0.2")
        self.assertAlmostEqual(self.wheel.heard[before][1], 0.1)
        wait_until(lambda: not self.wheel.moving(), "a stop")

    def test_space_stops_though_the_key_stays_down(self):
        self.page.key("w", True)
        self.assert_stops(lambda: self.page.key(" ", True), "the space bar")
        self.page.key(" ", False)
        self.page.key("w", False)


class Driving(Keys):
    Browser = chromium.Browser

    # --- fingers

    def press_finger(self, *path):
        """Down, along the path, until it drives; again where a busy browser drew too slowly."""
        def drives():
            nonlocal path
            start, *rest = path
            path = path[-1:]  # where a finger drives at once, without a frame between
            self.page.touch("touchStart", start)
            for point in rest:
                self.page.touch("touchMove", point)
            try:
                return wait_until(self.wheel.moving, "a finger that drives", 1.0)
            except AssertionError:
                self.page.touch("touchEnd")
                return False
        wait_until(drives, "a finger that drives")

    def test_a_finger_on_the_joystick_drives(self):
        box = self.page.evaluate("(({x, y, width}) => [x, y, width])("
                                 "document.querySelector('#joystick').getBoundingClientRect())")
        middle, top = (box[0] + box[2] / 2, box[1] + box[2] / 2), (box[0] + box[2] / 2, box[1] + 4)
        self.press_finger(middle, top)
        self.assert_stops(lambda: self.page.touch("touchEnd"), "the finger comes up")
        self.assertAlmostEqual(self.wheel.heard[-2][1], 0.2, delta=0.02)
        self.press_finger(top)
        self.assert_stops(lambda: self.page.touch("touchCancel"), "the touch is cancelled")
        self.press_finger(top)
        self.assert_stops(lambda: self.page.key(" ", True), "the space bar beside a finger")
        self.page.key(" ", False)
        self.page.touch("touchMove", middle)
        self.page.touch("touchMove", top)
        self.assertEqual("stopped", self.page.evaluate(
            "document.querySelector('#drive-state').dataset.state"), "a finger that was stopped")
        self.page.touch("touchEnd")

    def test_space_presses_no_button_that_was_clicked_before(self):
        self.page.evaluate("(() => { const button = document.querySelector('#reset');"
                           "button.focus(); button.onclick = () => { window.pressed = true; };"
                           "})()")
        self.page.key(" ", True)
        self.page.key(" ", False)
        self.assertFalse(self.page.evaluate("Boolean(window.pressed)"))
        self.page.evaluate("document.activeElement.blur()")

    def test_a_browser_that_draws_too_slowly_for_the_joystick_stops(self):
        x, y = self.page.evaluate("(({x, y, height}) => [x + 20, y + height / 2])("
                                  "document.querySelector('#joystick').getBoundingClientRect())")
        self.press_finger((x, y))
        no_frames = "window.kept = requestAnimationFrame; window.requestAnimationFrame = () => 0"
        self.assert_stops(lambda: self.page.evaluate(no_frames), "no frames come")
        self.page.evaluate("window.requestAnimationFrame = window.kept")
        self.page.touch("touchEnd")

    # --- what else must stop it

    def test_a_hidden_tab_stops(self):
        self.page.key("w", True)
        self.assert_stops(lambda: setattr(self, "other", self.browser.open("about:blank")),
                          "another tab comes to the front")
        self.other.close()
        self.page.to_front()
        self.page.key("w", False)

    def test_a_window_without_the_keyboard_stops(self):
        self.page.key("w", True)
        self.assert_stops(lambda: self.page.evaluate("window.dispatchEvent(new Event('blur'))"),
                          "another window takes the keyboard")
        self.page.key("w", False)

    def test_a_page_that_hangs_stops(self):
        self.page.key("w", True)
        wait_until(self.wheel.moving, "a command")
        hang = "setTimeout(() => { const end = Date.now() + 1200; while (Date.now() < end); })"
        self.assert_stops(lambda: self.page.evaluate(hang), "the page's script hangs")
        self.page.wait_for("document.querySelector('#drive-state[data-state=stopped]')?.textContent")
        self.page.key("w", False)
        self.assertFalse(self.wheel.moving(), "what was held before the page hung drives again")

    def test_a_closed_page_stops(self):
        page = self.drive_page(self.browser)
        page.key("w", True)
        self.assert_stops(page.close, "the tab is closed")
        self.page.to_front()

    def test_a_killed_browser_stops(self):
        browser = self.Browser()
        try:
            page = self.drive_page(browser)
            page.key("w", True)
            self.assert_stops(browser.process.kill, "the browser is killed")
        finally:
            browser.close()

    def test_a_cut_connection_and_silence_stop(self):
        for cut in (True, False):
            link = PageLink(self.url)
            self.hold(link, 0.5, linear=0.1)
            self.assert_stops(link.abort if cut else lambda: None,
                              "the connection is cut" if cut else "nothing more comes")
            link.close()

    def test_a_second_driver_stops_the_first_and_then_drives(self):
        link = PageLink(self.url)
        self.page.key("w", True)
        wait_until(self.wheel.moving, "the first driver's command")
        before = len(self.wheel.heard)
        began = time.monotonic()
        self.hold(link, 0.8, angular=0.5)
        self.assertIn("somebody else", self.page.wait_for(
            "document.querySelector('#drive-state[data-state=stopped]')?.textContent"))
        wait_until(lambda: not self.wheel.moving(), "a stop of the second driver")
        heard = self.wheel.heard[before:]
        zero = next(i for i, message in enumerate(heard) if not any(message[1:]))
        self.assertLess(heard[zero][0] - began, STOPPED_WITHIN)
        self.assertEqual({message[1:] for message in heard[zero:]}, {(0.0, 0.0), (0.0, 0.5)})
        self.page.key("w", False)
        link.close()

    def hold(self, link, seconds, linear=0.0, angular=0.0):
        """The messages of a held key."""
        for _ in range(round(seconds / PERIOD)):
            link.send("drive", linear=linear, angular=angular)
            rospy.rostime.wallsleep(PERIOD)

#!/usr/bin/env python3
"""Interactive markers in a browser: the mouse drags and clicks them, and their server hears it."""

import functools
import json
import math
import sys
import unittest

import chromium
import firefox
import orbit_view
import rospy
import rostest
import rviz_messages as made_up
from background import wait_until
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from interactive_messages import BALL, EVENTS, ball, scene
from sim_viewer.rviz.geometry import pose_of
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerControl as Mode

from bullet_sim.pose import Pose, multiply

TOLERANCE = 0.05  # m, of a click: a pixel or two
PRECISE = 0.01  # m or rad, of a drag by so many pixels
BASE_LINK = Pose.from_xyz_rpy((1.0, 0.5, 0.0), (0.0, 0.0, math.pi / 2))  # in map
DISTANCE, YAW, PITCH = 4.0, -2.0, 0.5  # from where a ball is looked at, m and rad
NEAREST = DISTANCE - BALL / 2  # of the ball
PER_PIXEL = 2 * math.pi / 300  # rad, in rviz
FROM_ABOVE = "window.rviz.viewport.orbit([0, 0, 0], 10, -Math.PI / 2, 1.57)"
PIXEL = """(({ _camera, canvas }) => 2 * Math.tan(_camera.fov * Math.PI / 360)
    / canvas.getBoundingClientRect().height)(window.rviz.viewport)"""  # m, 1 m away
PROJECT = """((x, y, z) => {
    const { viewport } = window.rviz;
    viewport._camera.updateMatrixWorld();  // it may not have been drawn since it was moved
    const { left, top, width, height } = viewport.canvas.getBoundingClientRect();
    const at = viewport._camera.position.clone().set(x, y, z).project(viewport._camera);
    return [left + (at.x + 1) / 2 * width, top + (1 - at.y) / 2 * height];
})"""


@functools.cache
def marker_server():
    """One for both browsers: it cannot be ended."""
    return InteractiveMarkerServer("handles")


class InteractivePage(unittest.TestCase):
    Browser = chromium.Browser

    @classmethod
    def setUpClass(cls):
        cls.tf = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.tf.publish(TFMessage(made_up.transforms()))
        cls.heard = []
        cls.server = marker_server()
        for marker in [*scene(), ball(Mode.MOVE_3D)]:
            cls.server.insert(marker, cls.take)
        cls.server.applyChanges()
        cls.browser = cls.Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.page = cls.open("/sim_viewer/url")

    @classmethod
    def take(cls, message):
        cls.heard.append(message)
        cls.server.applyChanges()  # so that the page hears what it has done

    @classmethod
    def open(cls, parameter):
        """A page that shows all markers, seen from 10 m above."""
        url = wait_until(lambda: rospy.get_param(parameter, ""), "the page's address")
        page = cls.browser.open(url + "#rviz")
        page.wait_for("window.rviz?.session.displays[0].shown?.group.children.length === 8")
        page.evaluate(FROM_ABOVE)
        return page

    def setUp(self):
        self.heard.clear()

    def tearDown(self):
        self.assertEqual(self.page.errors, [])

    def mouse(self, kind, *place, button="left", page=None):
        """At a place in map, m."""
        page = page or self.page
        page.mouse(kind, *page.evaluate(f"{PROJECT}(...{json.dumps(place)})"), button)

    def drag(self, first, *others, page=None):
        self.mouse("Pressed", *first, page=page)
        for place in others:
            self.mouse("Moved", *place, page=page)
        self.mouse("Released", *others[-1], page=page)

    def last(self, event):
        """The feedback of a kind, once the hand has let go and all has come."""
        self.wait_for(event)
        return [one for one in self.heard if EVENTS[one.event_type] == event][-1]

    def wait_for(self, event):
        wait_until(lambda: event in [EVENTS[one.event_type] for one in self.heard], event)

    def events(self):
        """In order, each once."""
        names = [EVENTS[one.event_type] for one in self.heard]
        return [name for name in dict.fromkeys(names) if name != "KEEP_ALIVE"]

    def place(self, marker):
        """Where its first part stands in the scene, x and y in m."""
        return self.page.evaluate(f"""(() => {{
            const {{ shown }} = window.rviz.session.displays[0];
            const number = shown._markers.findIndex((one) => one.key.endsWith({marker!r}));
            const {{ x, y }} = shown.group.children.find(
                (one) => one.userData.owner.marker === number).position;
            return [x, y];
        }})()""")

    def near(self, place, expected, tolerance=TOLERANCE):
        for one, other in zip(place, expected, strict=True):
            self.assertAlmostEqual(one, other, delta=tolerance)

    def grasp_ball(self, mode):
        """It is in its place, seen and held in the middle of the picture. All is in its frame."""
        self.server.insert(ball(mode), self.take)
        self.server.applyChanges()
        self.page.wait_for(f"""(({{ _held, _markers }}) => !_held.size && _markers.find(
            (one) => one.key.endsWith("ball")).controls[0].mode === {mode})(
            window.rviz.session.displays[0].shown)""")
        self.start = pose_of(ball(mode).pose)
        middle = BASE_LINK.transform(self.start.position)
        wait_until(lambda: math.dist(self.place("ball"), middle[:2]) < PRECISE, "the ball there")
        self.addCleanup(self.page.evaluate, FROM_ABOVE)
        self.page.evaluate(
            f"window.rviz.viewport.orbit({list(middle)}, {DISTANCE}, {YAW}, {PITCH})")
        self.right, self.up, self.towards = orbit_view.axes(YAW, PITCH, BASE_LINK)
        self.at = [round(one) for one in self.page.evaluate(f"{PROJECT}(...{list(middle)})")]
        self.page.mouse("Pressed", *self.at)

    def across(self, right, down, distance=NEAREST):
        """What so many pixels are where the ball is held."""
        pixel = distance * self.page.evaluate(PIXEL)
        return pixel * (right * self.right - down * self.up)

    def pull(self, right, down, *keys):
        """By so many pixels, while keys are held."""
        for key in keys:
            self.page.key(key, True)
        self.at = [self.at[0] + right, self.at[1] + down]
        self.page.mouse("Moved", *self.at)
        for key in keys:
            self.page.key(key, False)

    def let_go(self):
        self.page.mouse("Released", *self.at)
        self.wait_for("MOUSE_UP")
        return self.last("POSE_UPDATE")

    def has_ball(self, feedback, by, *turns):
        """Moved by a vector in m, and turned about axes by pixels, the last one first."""
        pose, turned = pose_of(feedback.pose), self.start.orientation
        for axis, pixels in reversed(turns):
            turned = multiply(orbit_view.turn(axis, pixels * PER_PIXEL), turned)
        self.assertEqual(feedback.header.frame_id, "base_link")
        self.near(pose.position, self.start.position + by, PRECISE)
        self.assertLess(orbit_view.angle_between(pose.orientation, turned), PRECISE)

    def test_1_an_arrow_is_pushed_along_its_axis_only(self):
        self.near(self.place("pushed"), (0.0, 1.0))  # the frame odom is 0.5 m to the right
        self.drag((0.6, 1.0, 0.0), (1.0, 1.0, 0.0), (1.6, 1.4, 0.0))
        self.wait_for("MOUSE_UP")
        self.assertEqual(self.events(), ["MOUSE_DOWN", "POSE_UPDATE", "MOUSE_UP"])
        first, last = self.heard[0], self.last("POSE_UPDATE")
        self.assertEqual((last.marker_name, last.control_name, last.header.frame_id),
                         ("pushed", "along", "odom"))
        self.assertRegex(last.client_id, "^/sim_viewer/[0-9]+/[0-9]+$")
        self.near((first.pose.position.x, first.pose.position.y), (-0.5, 1.0))
        self.assertTrue(first.mouse_point_valid)
        self.near((first.mouse_point.x, first.mouse_point.y), (0.1, 1.0))
        self.near((last.pose.position.x, last.pose.position.y, last.pose.position.z),
                  (0.5, 1.0, 0.0))
        wait_until(lambda: abs(self.place("pushed")[0] - 1.0) < TOLERANCE, "the marker there")

    def test_2_a_marker_is_moved_in_its_plane(self):
        self.near(self.place("moved"), (-2.0, 1.5))
        self.drag((-2.0, 1.5, 0.2), (-1.5, 1.0, 0.2), (-1.0, 0.5, 0.2))
        self.wait_for("MOUSE_UP")
        pose = self.last("POSE_UPDATE").pose
        self.near((pose.position.x, pose.position.y), (-1.0, 0.5))
        wait_until(lambda: abs(self.place("moved")[0] + 1.0) < TOLERANCE, "the marker there")

    def test_2_a_ring_is_turned_by_a_quarter(self):
        self.drag((2.58, -1.5, 0.0), (2.4, -1.1, 0.0), (2.0, -0.92, 0.0))
        self.wait_for("MOUSE_UP")
        pose = self.last("POSE_UPDATE").pose
        self.near((pose.position.x, pose.position.y), (2.0, -1.5))
        self.near((pose.orientation.x, pose.orientation.y, pose.orientation.z,
                   pose.orientation.w), (0.0, 0.0, 0.7071, 0.7071))

    def test_3_a_ball_is_moved_in_the_plane_of_the_screen(self):
        self.grasp_ball(Mode.MOVE_3D)
        self.pull(100, 40)
        self.pull(50, -130)
        last, point = self.let_go(), self.last("MOUSE_UP").mouse_point
        by = self.across(150, -90)
        self.has_ball(last, by)
        self.near((point.x, point.y, point.z),
                  self.start.position + BALL / 2 * self.towards + by, PRECISE)

    def test_3_a_ball_is_moved_away_with_shift(self):
        self.grasp_ball(Mode.MOVE_3D)
        self.pull(10, -60, "Shift")
        self.pull(-20, 10, "Shift")
        self.pull(30, 0)
        away = 40 * orbit_view.below(10, self.page.evaluate(PIXEL), NEAREST, PITCH) / 10
        self.has_ball(self.let_go(), self.across(30, 0, NEAREST + away) - away * self.towards)

    def test_3_a_ball_is_turned_across_the_drag_and_with_shift_in_the_screen(self):
        self.grasp_ball(Mode.ROTATE_3D)
        self.pull(60, -30)
        self.pull(-20, 50, "Shift")
        self.has_ball(self.let_go(), self.across(0, 0),
                      (self.towards, -50), (self.up, 60), (self.right, -30))

    def test_3_a_ball_is_moved_or_with_control_turned(self):
        self.grasp_ball(Mode.MOVE_ROTATE_3D)
        self.pull(60, -30, "Control")
        self.pull(-40, 20, "Control", "Shift")
        self.pull(-90, 60)
        self.has_ball(self.let_go(), self.across(-90, 60),
                      (self.towards, 40), (self.up, 60), (self.right, -30))

    def test_3_a_button_is_clicked(self):
        self.drag((-2.0, -1.5, 0.2), (-2.0, -1.5, 0.2))
        self.wait_for("BUTTON_CLICK")
        self.assertEqual(self.events(), ["MOUSE_DOWN", "MOUSE_UP", "BUTTON_CLICK"])
        self.assertEqual(self.last("BUTTON_CLICK").control_name, "button")

    def test_3_what_is_refused_loses_nothing_else(self):
        self.page.evaluate("""(({ _hand }) => {
            const call = _hand._call;
            _hand._call = (operation, message) => {
                if (message.event === "BUTTON_CLICK") _hand._call = call;
                return message.event === "MOUSE_DOWN" ? new Promise((_, refuse) =>
                    setTimeout(refuse, 500, new Error("not now"))) : call(operation, message);
            };
        })(window.rviz.session.displays[0].shown)""")
        self.drag((-2.0, -1.5, 0.2), (-2.0, -1.5, 0.2))
        self.wait_for("BUTTON_CLICK")
        self.assertEqual(self.events(), ["MOUSE_UP", "BUTTON_CLICK"])

    def test_4_an_entry_of_a_menu_is_chosen(self):
        for kind in ("Pressed", "Released"):
            self.mouse(kind, -2.0, -1.5, 0.2, button="right")
        self.page.wait_for("!!document.querySelector('.rviz-menu')")
        self.assertEqual(self.page.evaluate(
            "[...document.querySelectorAll('.rviz-menu button')].map("
            "(one) => [one.textContent, one.disabled])"), [["Home", False], ["Shell", True]])
        self.page.evaluate("document.querySelector('.rviz-menu [data-entry=\"2\"]').click()")
        self.wait_for("MENU_SELECT")
        chosen = self.last("MENU_SELECT")
        self.assertEqual((chosen.marker_name, chosen.menu_entry_id), ("clicked", 2))
        self.assertFalse(self.page.evaluate("!!document.querySelector('.rviz-menu')"))

    def test_4_words_are_clicked_for_their_menu(self):
        self.drag((0.5, -1.625, 0.0), (0.5, -1.625, 0.0))  # above the marker, as one sees it
        self.page.wait_for("!!document.querySelector('.rviz-menu')")
        self.assertEqual(self.page.evaluate(
            "document.querySelector('.rviz-menu span').textContent"), "More")
        self.drag((0.5, -0.5, 0.0), (0.5, -0.5, 0.0))  # beside it
        self.assertFalse(self.page.evaluate("!!document.querySelector('.rviz-menu')"))

    def test_5_beside_the_handles_the_camera_is_moved(self):
        look = "window.rviz.viewport._camera.position.toArray().join()"
        before = self.page.evaluate(look)
        self.drag((0.5, -0.5, 0.0), (1.0, -1.0, 0.0))
        self.page.wait_for(f"{look} !== {before!r}")
        self.page.evaluate(FROM_ABOVE)
        self.assertEqual(self.heard, [])

    def test_5_the_display_is_added_by_hand(self):
        self.page.evaluate("""
            document.querySelector('#rviz-kind').value = 'rviz/InteractiveMarkers';
            document.querySelector('#rviz-add').click();
            (box => { box.value = '/handles/update'; box.dispatchEvent(new Event('change')); })(
                document.querySelector('[data-name=InteractiveMarkers] .topic'))""")
        self.page.wait_for("window.rviz.session.displays[1].shown?.group.children.length === 8")
        self.page.wait_for("window.rviz.session.displays[1].statuses.some("
                           "([name, level]) => name.startsWith('/') && level === 'ok')")
        self.page.evaluate("document.querySelector('[data-name=InteractiveMarkers] .remove')"
                           ".click()")
        self.assertEqual(self.page.evaluate("window.rviz.session.displays.length"), 1)

    def test_6_the_server_moves_and_erases_a_marker(self):
        self.server.setPose("turned", made_up.at(2.0, 2.0))
        self.server.erase("moved")
        self.server.applyChanges()
        wait_until(lambda: abs(self.place("turned")[1] - 2.0) < TOLERANCE, "the marker there")
        self.page.wait_for("window.rviz.session.displays[0].shown.group.children.length === 7")
        self.server.insert(scene()[3], self.take)
        self.server.applyChanges()

    def test_7_a_page_without_control_only_looks(self):
        page = self.open("/looker/url")
        self.drag((-2.0, -1.5, 0.2), (0.0, 0.0, 0.2), page=page)
        said = page.evaluate("""import("./link.js").then((link) => link.call("rviz_feedback", {
            display: 1, marker: "", control: "", event: "MOUSE_DOWN", pose: [], point: [] })).catch(
            (error) => error.message)""")
        self.assertIn("may only look", said)
        self.assertEqual(self.heard, [])
        self.assertEqual(page.errors, [])


class InteractivePageInFirefox(InteractivePage):
    Browser = firefox.Browser


if __name__ == "__main__":
    rospy.init_node("interactive_page_story")
    rostest.rosrun("sim_viewer", "interactive_page", "__main__", sys.argv)

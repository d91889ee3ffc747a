#!/usr/bin/env python3
"""Interactive markers in a browser: the mouse drags and clicks them, and their server hears it."""

import json
import sys
import unittest

import chromium
import firefox
import rospy
import rostest
import rviz_messages as made_up
from background import wait_until
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from interactive_messages import EVENTS, scene
from tf2_msgs.msg import TFMessage

BROWSERS = {"chromium": chromium, "firefox": firefox}
TOLERANCE = 0.05  # m, of a click: a pixel or two
PROJECT = """((x, y, z) => {
    const { viewport } = window.rviz;
    viewport._camera.updateMatrixWorld();  // it may not have been drawn since it was moved
    const { left, top, width, height } = viewport.canvas.getBoundingClientRect();
    const at = viewport._camera.position.clone().set(x, y, z).project(viewport._camera);
    return [left + (at.x + 1) / 2 * width, top + (1 - at.y) / 2 * height];
})"""


class InteractivePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tf = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.tf.publish(TFMessage(made_up.transforms()))
        cls.heard = []
        cls.server = InteractiveMarkerServer("handles")
        for marker in scene():
            cls.server.insert(marker, cls.take)
        cls.server.applyChanges()
        cls.browser = BROWSERS[rospy.get_param("~browser", "chromium")].Browser()
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
        page.wait_for("window.rviz?.session.displays[0].shown?.group.children.length === 7")
        page.evaluate("window.rviz.viewport.orbit([0, 0, 0], 10, -Math.PI / 2, 1.57)")
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

    def near(self, place, expected):
        for one, other in zip(place, expected, strict=True):
            self.assertAlmostEqual(one, other, delta=TOLERANCE)

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

    def test_3_a_button_is_clicked(self):
        self.drag((-2.0, -1.5, 0.2), (-2.0, -1.5, 0.2))
        self.wait_for("BUTTON_CLICK")
        self.assertEqual(self.events(), ["MOUSE_DOWN", "MOUSE_UP", "BUTTON_CLICK"])
        self.assertEqual(self.last("BUTTON_CLICK").control_name, "button")

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
        self.page.evaluate("window.rviz.viewport.orbit([0, 0, 0], 10, -Math.PI / 2, 1.57)")
        self.assertEqual(self.heard, [])

    def test_5_the_display_is_added_by_hand(self):
        self.page.evaluate("""
            document.querySelector('#rviz-kind').value = 'rviz/InteractiveMarkers';
            document.querySelector('#rviz-add').click();
            (box => { box.value = '/handles/update'; box.dispatchEvent(new Event('change')); })(
                document.querySelector('[data-name=InteractiveMarkers] .topic'))""")
        self.page.wait_for("window.rviz.session.displays[1].shown?.group.children.length === 7")
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
        self.page.wait_for("window.rviz.session.displays[0].shown.group.children.length === 6")
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


if __name__ == "__main__":
    rospy.init_node("interactive_page_story")
    rostest.rosrun("sim_viewer", "interactive_page", InteractivePage, sys.argv)

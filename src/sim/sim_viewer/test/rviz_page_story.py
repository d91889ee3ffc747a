#!/usr/bin/env python3
"""The tab RViz in a browser: what is in the scene is what was published, and tools publish."""

import json
import math
import sys
import unittest

import chromium
import firefox
import rospy
import rostest
import rviz_messages as made_up
from background import wait_until
from geometry_msgs.msg import PointStamped, PoseStamped, PoseWithCovarianceStamped
from tf2_msgs.msg import TFMessage
from tool_link import ToolLink

TOPICS = {"/tf_static": lambda: TFMessage([*made_up.transforms(), made_up.eye()]),
          "/map": made_up.grid, "/scan": made_up.scan, "/plan": made_up.path,
          "/particlecloud": made_up.particles, "/amcl_pose": made_up.estimate,
          "/footprint": made_up.footprint,
          "/sonar": made_up.sonar, "/markers": made_up.markers, "/cloud": made_up.cloud,
          "/odom": made_up.odometry, "/marker": made_up.marker,
          "/lost_scan": lambda: made_up.scan("nowhere"), "/picture": made_up.picture,
          "/eye/image_raw": made_up.view_from_above, "/eye/camera_info": made_up.camera_info}
TOLERANCE = 0.1  # m, of a click: some pixels


class RvizPage(unittest.TestCase):
    Browser = chromium.Browser

    @classmethod
    def setUpClass(cls):
        rospy.set_param("/robot_description", made_up.URDF)
        cls.publishers = {}
        for topic, make in TOPICS.items():
            message = make()
            cls.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=1, latch=True)
            cls.publishers[topic].publish(message)
            cls.addClassCleanup(cls.publishers[topic].unregister)
        cls.heard = {}
        for topic, kind in (("/move_base_simple/goal", PoseStamped),
                            ("/clicked_point", PointStamped),
                            ("/initialpose", PoseWithCovarianceStamped)):
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.heard.update(
                {topic: message}))
        cls.url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.browser = cls.Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.page = cls.browser.open(cls.url + "#rviz")
        cls.page.wait_for("!!window.rviz")

    def tearDown(self):
        self.assertEqual(self.page.errors, [])

    def display(self, name):
        """JavaScript for a display of this name."""
        return f"window.rviz.session.displays.find((one) => one.name === {json.dumps(name)})"

    def wait(self, name, script):
        """The first true value of a script about the display `d` and the parts `parts` of it."""
        return self.page.wait_for(
            f"(() => {{ const d = {self.display(name)}; const parts = d?.shown?.group?.children;"
            f" try {{ return {script}; }} catch {{ return false; }} }})()")

    def status(self, name, text):
        self.wait(name, f"d.statuses.some((one) => one[2] === {json.dumps(text)})")

    def entry(self, name, script):
        return self.page.evaluate(
            f"(entry => {{ {script} }})(document.querySelector('[data-name=\"{name}\"]'))")

    def test_1_the_scene_has_what_was_published(self):
        scene = {
            "Scan": f"parts[0].geometry.attributes.position.count === {made_up.HITS}",
            "Map": "parts[0].children[0].material.uniforms.cells.value.image.width === 80"
                   " && parts[0].children[0].material.uniforms.cells.value.image.height === 60"
                   " && Math.abs(parts[0].children[0].scale.x - 8) < 1e-5"
                   " && parts[0].position.x === -3",
            "Plan": "parts[0].geometry.instanceCount === 49",
            "Particles": "parts[0].geometry.instanceCount === 40 * 3",
            "Estimate": "parts.length === 4", "Footprint": "parts[0].geometry.instanceCount === 4",
            "Cloud": "parts[0].geometry.attributes.position.count >= 10000",
            "Odometry": "parts.length === 2 && parts[0].children[0].count === 1",
            "Marker": "parts[0].children[0].count === 1 && d.namespaces.join() === 'one'",
            "Sonar": "parts[0].children[0].count === 1",
            "TF": "parts.at(-1).children.map((one) => one.name).join() === "
                  "'base_link,eye,laser,map,odom'",
            "Robot": "parts[0].children[0].children.length === 1"
                     " && parts[0].children[0].position.x === 1",
            "Markers": "parts.length === 10 && parts.flatMap((one) => one.children).reduce("
                       "(sum, one) => sum + (one.isInstancedMesh ? one.count : 0), 0) === 13",
        }
        for name, script in scene.items():
            self.wait(name, script)
        self.status("Scan", "1 messages received")
        self.status("Silent", "No messages received")
        self.status("Lost", "For frame [nowhere]: Frame [nowhere] does not exist")
        self.assertIn("of 1000000 points", self.wait(
            "Cloud", "d.statuses.find((one) => one[0] === 'Points')?.[2]"))
        self.assertEqual(self.page.evaluate(f"{self.display('Strange')}.statuses[0][2]"),
                         "not supported here")
        self.page.wait_for("document.querySelector('.rviz-pictures img')?.naturalWidth === 64")
        self.page.wait_for("document.querySelector('[data-name=Lost]').dataset.level === 'error'")
        # What takes long to draw here is not drawn any more.
        self.entry("Cloud", "entry.querySelector('.check input').click()")
        self.page.wait_for(f"!{self.display('Cloud')}.shown")

    def test_2_options_topics_and_the_fixed_frame_are_changed(self):
        self.entry("Scan", """const box = entry.querySelector('[data-option="Style"] select');
            box.value = 'Points'; box.dispatchEvent(new Event('change'));""")
        self.wait("Scan", "parts[0].material.uniforms.inPixels.value")
        self.entry("Lost", """const box = entry.querySelector('.topic');
            box.value = '/scan'; box.dispatchEvent(new Event('change'));""")
        self.wait("Lost", f"parts[0]?.geometry.attributes.position.count === {made_up.HITS}")
        self.publishers["/scan"].publish(made_up.scan("nowhere"))
        self.page.evaluate("""(box => { box.value = 'odom'; box.dispatchEvent(new Event('change'));
            })(document.querySelector('#rviz-fixed'))""")
        self.wait("Map", "parts[0].position.x === -3.5")
        self.wait("Scan", "parts[0]?.position.x === 0.5")
        self.page.evaluate("""(box => { box.value = 'map'; box.dispatchEvent(new Event('change'));
            })(document.querySelector('#rviz-fixed'))""")
        self.wait("Map", "parts[0].position.x === -3")

    def pixel(self, name, column, row):
        """What a camera's display draws there, RGBA; 0 to 1 from the left and from above."""
        return self.wait(name, f"""(() => {{
            d.shown.render();
            const {{ canvas }} = d.shown;
            return [...canvas.getContext("2d").getImageData(
                {column} * canvas.width, {row} * canvas.height, 1, 1).data];
        }})()""")

    def test_2_a_camera_shows_the_scene_over_its_picture(self):
        self.page.wait_for("document.querySelector('.layers img')?.naturalWidth === 64")
        for name in ("Grid", "Map", "TF"):  # they are there too
            self.entry(name, "entry.querySelector('.check input').click()")
            self.addCleanup(self.entry, name, "entry.querySelector('.check input').click()")
        red, _, blue, alpha = self.pixel("Eye", 0.25, 0.5)  # the marker, which one sees through
        self.assertGreater(red, blue + 50)
        self.assertTrue(100 < alpha < 220, alpha)
        self.assertEqual(self.pixel("Eye", 0.75, 0.5)[3], 0)  # nothing, so the picture is seen
        self.assertEqual(self.page.evaluate(
            "[...document.querySelectorAll('.layers img')].map((one) => one.style.opacity).join()"),
            "1,0.25")
        self.status("Eye", "Transform OK")
        self.entry("Eye", """const box = entry.querySelector('[data-option="Zoom Factor"] input');
            box.value = 2; box.dispatchEvent(new Event('change'));""")
        # Twice as large about the picture's middle: what was a quarter from the left leaves it.
        self.page.wait_for("document.querySelector('.layers img').style.transform === 'scale(2)'")
        self.assertGreater(self.pixel("Eye", 0.01, 0.5)[3], 100)
        self.assertEqual(self.pixel("Eye", 0.25, 0.5)[3], 0)

    def test_3_a_map_is_updated(self):
        updates = rospy.Publisher("/map_updates", type(made_up.update()), queue_size=1, latch=True)
        self.addCleanup(updates.unregister)
        updates.publish(made_up.update())
        self.wait("Map", "parts[0].children[0].material.uniforms.cells.value.image"
                         ".data[20 * 80 + 10] === 50")

    def test_3_displays_are_added_and_removed(self):
        self.page.evaluate("document.querySelector('#rviz-kind').value = 'rviz/Axes';"
                           "document.querySelector('#rviz-add').click()")
        self.wait("Axes", "parts.length === 3")
        self.entry("Axes", "entry.querySelector('.remove').click()")
        self.assertFalse(self.page.evaluate(f"Boolean({self.display('Axes')})"))

    # --- tools

    def look_down(self):
        """The place in px at which the view's middle is, from 10 m above map's origin."""
        self.page.evaluate("window.rviz.viewport.orbit([0, 0, 0], 10, -Math.PI / 2, 1.57)")
        return self.page.evaluate("(({x, y, width, height}) => [x + width / 2, y + height / 2])("
                                  "window.rviz.viewport.canvas.getBoundingClientRect())")

    def drag(self, tool, *by):
        """With a tool, from the view's middle, and by further px."""
        x, y = self.look_down()
        self.page.evaluate(f"document.querySelector('#rviz-tool-{tool}').click()")
        for kind, (right, down) in zip(("Pressed", "Moved", "Released"),
                                       ((0, 0), by or (0, 0), by or (0, 0))):
            self.page.mouse(kind, x + right, y + down)

    def test_4_a_goal_and_a_pose_are_given_by_a_drag(self):
        self.drag("goal", 0, -100)  # up, which is +y
        goal = wait_until(lambda: self.heard.get("/move_base_simple/goal"), "a goal")
        self.assertEqual(goal.header.frame_id, "map")
        self.assertLess(abs(rospy.Time.now() - goal.header.stamp).to_sec(), 20.0)
        self.assertLess(math.hypot(goal.pose.position.x, goal.pose.position.y), TOLERANCE)
        self.assertAlmostEqual(goal.pose.orientation.z, math.sqrt(0.5), places=1)
        self.wait("Goal", "parts.length === 2")  # the page's own goal comes back
        self.drag("initial_pose", 100, 0)
        pose = wait_until(lambda: self.heard.get("/initialpose"), "a pose").pose
        self.assertAlmostEqual(pose.pose.orientation.z, 0.0, places=1)
        self.assertEqual([pose.covariance[i] for i in (0, 7, 35)],
                         [0.25, 0.25, 0.06853891945200942])
        self.assertEqual(sum(map(bool, pose.covariance)), 3)

    def test_5_a_point_is_clicked_and_a_way_is_measured(self):
        self.drag("point")
        point = wait_until(lambda: self.heard.get("/clicked_point"), "a point")
        self.assertLess(math.hypot(point.point.x, point.point.y), TOLERANCE)
        self.drag("measure")
        x, y = self.look_down()
        self.page.mouse("Pressed", x + 100, y)
        self.page.mouse("Released", x + 100, y)
        self.page.wait_for(
            "/^1\\.[0-9]+ m$/.test(document.querySelector('#rviz-said').textContent)")
        self.drag("focus")
        self.page.wait_for("document.querySelector('#rviz-tool-move').ariaPressed === 'true'")

    def test_6_a_robot_without_a_simulator_is_in_the_tab_3d(self):
        link = ToolLink(self.url)
        self.addCleanup(link.close)
        poses = link.watch("poses")
        poses.until(lambda event: event.get("names") == ["box::base_link"], "the robot's link")


class RvizPageInFirefox(RvizPage):
    Browser = firefox.Browser


if __name__ == "__main__":
    rospy.init_node("rviz_page_story")
    rostest.rosrun("sim_viewer", "rviz_page", "__main__", sys.argv)

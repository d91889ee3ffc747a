#!/usr/bin/env python3
"""The tools show what is true of the turtle, and change only what they say."""

import subprocess
import sys
import unittest
from itertools import groupby
from pathlib import Path

import rosgraph
import rospy
import rostest
from background import wait_until
from tool_link import ToolLink
from tools_page_story import ToolsPage  # noqa: F401, rostest finds it by this module's name
from turtlesim.msg import Pose

POSE = "/turtle1/pose"
RECORDED = 3.0  # s


def rosbag(*arguments):
    done = subprocess.run(["rosbag", *arguments], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Tools(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_message(POSE, Pose, 60.0)
        cls.folder = Path(rospy.get_param("/sim_viewer/bags").strip())
        url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")
        cls.link = ToolLink(url)
        cls.addClassCleanup(cls.link.close)

    def test_the_graph_has_who_speaks_to_whom(self):
        graph = self.link.watch("graph", view="active")
        arrows = {("n/draw_square", "t/turtle1/cmd_vel"), ("t/turtle1/cmd_vel", "n/turtlesim"),
                  ("n/turtlesim", "t/turtle1/pose"), ("t/turtle1/pose", "n/draw_square")}
        graph.until(lambda data: arrows <= {(e["from"], e["to"]) for e in data["edges"]},
                    "the turtle's arrows")
        graph.stop()

    def test_a_plot_has_the_values_of_the_topic(self):
        heard = []
        subscriber = rospy.Subscriber(POSE, Pose, heard.append)
        wait_until(lambda: heard, "the turtle's pose")
        lines = self.link.data("plot_expand", path="/turtle1/pose/x:theta")
        self.assertEqual(lines, ["/turtle1/pose/x", "/turtle1/pose/theta"])
        plot = self.link.watch("plot", paths=lines)
        wait_until(lambda: sum(len(e.get(lines[1], [])) for e in plot.events) > 100, "samples")
        plot.stop()
        for line, field in zip(lines, ("x", "theta")):
            shown = [value for event in plot.events for _, value in event.get(line, [])]

            def in_order(field=field, shown=shown):
                # The turtle queues one pose for each of us, so that a late one misses some.
                true = [getattr(pose, field) for pose in heard]
                both = [value for value, _ in groupby(shown) if value in true]
                rest = iter(true)
                return len(both) > len(list(groupby(shown))) / 2 and all(v in rest for v in both)

            wait_until(in_order, f"{line}: the shown values, in this order")
        subscriber.unregister()
        times = [moment for event in plot.events for moment, _ in event[lines[0]]]
        self.assertEqual(times, sorted(times))
        self.assertIn("/turtle1/pose/theta", self.link.data("plot_fields", topic=POSE))
        self.assertIn("no field 'z'", self.link.error("plot_expand", path="/turtle1/pose/z"))

    def test_the_console_has_a_line_that_was_logged(self):
        console = self.link.watch("console", level="warn")
        end = rospy.Time.now() + rospy.Duration(60.0)
        while not console.events and rospy.Time.now() < end:  # until the page has subscribed
            rospy.loginfo("nothing to see")
            rospy.logwarn("the turtle is <b>hungry</b>")
            rospy.sleep(0.2)
        console.stop()
        lines = [line for event in console.events for line in event["lines"]]
        self.assertEqual({(line["level"], line["node"], line["text"]) for line in lines},
                         {("warn", rospy.get_name(), "the turtle is <b>hungry</b>")})

    def test_topics_have_types_rates_and_messages(self):
        rows = self.link.watch("topics").until(
            lambda rows: any(row["name"] == POSE for row in rows), "the pose in the list")
        row = next(row for row in rows if row["name"] == POSE)
        self.assertEqual((row["type"], row["publishers"]), ("turtlesim/Pose", ["/turtlesim"]))
        rate = self.link.watch("rate", topic=POSE)
        rate.until(lambda data: abs(data["rate"] - 62.5) < 3.0 and data["bandwidth"] > 1000,
                   "62.5 poses a second")
        rate.stop()
        echo = self.link.watch("echo", topic=POSE)
        text = echo.until(lambda data: data["publisher"] == "/turtlesim", "a pose")["text"]
        echo.stop()
        self.assertRegex(text, r"^x: [\d.]+\ny: [\d.]+\ntheta: [-\d.e]+\nlinear_velocity: ")
        self.assertIn("/nothing: no such topic",
                      self.link.error("watch", what="echo", args={"topic": "/nothing"}))

    def test_services_have_a_form_and_answer(self):
        self.assertIn({"name": "/spawn", "node": "/turtlesim"}, self.link.data("services"))
        form = self.link.data("service", name="/spawn")
        self.assertEqual(form["type"], "turtlesim/Spawn")
        filled = form["request"].replace("x: 0.0", "x: 2.0").replace('""', '"leo"')
        answer = self.link.data("call_service", name="/spawn", request=filled)
        self.assertEqual(answer, 'name: "leo"')
        self.assertEqual(rospy.wait_for_message("/leo/pose", Pose, 60.0).x, 2.0)
        for request, reason in (("z: 1", "no field 'z'; turtlesim/SpawnRequest has: x, y, theta"),
                                ("x: far", "x is 'far', which is not of type float32")):
            error = self.link.error("call_service", name="/spawn", request=request)
            self.assertIn(reason, error)
            self.assertNotIn("\n", error)
        again = self.link.error("call_service", name="/spawn", request=filled)
        self.assertIn("/spawn: ", again)
        self.assertIn("no such service", self.link.error("service", name="/spawm"))

    def test_a_parameter_that_is_set_is_set(self):
        row = self.link.data("set_parameter", name="/turtlesim/background_r", value="200")
        self.assertEqual((row["type"], row["value"]), ("int", "200"))
        self.assertEqual(rospy.get_param("/turtlesim/background_r"), 200)
        self.link.data("set_parameter", name="/gains", value="{p: 1.5, names: [a, 'b: c']}")
        self.assertEqual(rospy.get_param("/gains"), {"p": 1.5, "names": ["a", "b: c"]})
        names = {row["name"]: row["value"] for row in self.link.data("parameters")}
        self.assertEqual(names["/gains/p"], "1.5")
        self.link.data("delete_parameter", name="/gains")
        self.assertFalse(rospy.has_param("/gains"))
        self.assertIn("32 bits", self.link.error("set_parameter", name="/gains", value="1" * 12))
        self.assertIn("/gains", self.link.error("delete_parameter", name="/gains"))

    def test_a_bag_is_recorded_read_and_played(self):
        state = self.link.watch("bags")
        self.assertEqual(self.link.data("record", name="turtle", topics=[POSE]), "turtle.bag")
        self.assertIn("is being recorded", self.link.error("record", topics=[]))
        state.until(lambda data: data["recording"] and data["recording"]["seconds"] > RECORDED,
                    "three seconds")
        self.link.data("stop_record")
        path = self.folder / "turtle.bag"
        self.assertIn(f"topics:      {POSE}", rosbag("info", str(path)))
        facts = self.link.data("bag_info", name="turtle.bag")
        self.assertEqual([topic["name"] for topic in facts["topics"]], [POSE])
        self.assertGreater(facts["messages"], 100)
        self.assertGreater(facts["duration"], 2.0)
        players = set()
        subscriber = rospy.Subscriber(
            POSE, Pose, lambda pose: players.add(pose._connection_header["callerid"]))
        self.link.data("play", name="turtle.bag", rate=2.0)
        wait_until(lambda: any(name.startswith("/play") for name in players), "the bag's poses")
        state.until(lambda data: data["playing"], "the page says that it plays")
        self.link.data("stop_play")
        wait_until(lambda: not state.events[-1]["playing"], "it has stopped")
        subscriber.unregister()
        state.stop()
        self.assertEqual(state.events[-1]["note"], "")
        self.assertIn("exists already", self.link.error("record", name="turtle", topics=[]))

    def test_frames_have_their_place(self):
        tf = self.link.watch("tf")
        rows = tf.until(lambda rows: len(rows) == 2, "both frames")
        tf.stop()
        self.assertEqual([(row["frame"], row["depth"]) for row in rows],
                         [("world", 0), ("camera", 1)])
        self.assertEqual((rows[1]["place"], rows[1]["publisher"], rows[1]["static"]),
                         ([1.0, 2.0, 3.0], "/fixed", True))

    def test_what_nobody_watches_is_not_subscribed_to(self):
        def subscribed():
            _, subscribers, _ = rosgraph.Master("/story").getSystemState()
            return {topic for topic, nodes in subscribers if "/sim_viewer" in nodes}

        other = ToolLink(rospy.get_param("/sim_viewer/url"))
        other.watch("plot", paths=["/turtle1/pose/x"])
        other.watch("echo", topic="/turtle1/color_sensor")
        other.watch("console")
        other.watch("tf")
        other.watch("status")
        wanted = {POSE, "/turtle1/color_sensor", "/rosout_agg", "/tf", "/tf_static", "/clock"}
        wait_until(lambda: wanted <= subscribed(), "all subscriptions")
        other.abort()  # it closes without a word
        wait_until(lambda: not wanted & subscribed(), "no subscription left")


if __name__ == "__main__":
    rospy.init_node("tools_story")
    rostest.rosrun("sim_viewer", "tools", "__main__", sys.argv)

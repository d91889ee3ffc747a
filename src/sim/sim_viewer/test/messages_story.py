#!/usr/bin/env python3
"""Topics that are hard to show: watched in several ways at once, huge, of no known type, gone."""

import io
import sys
import time
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from background import wait_until
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid
from node_process import process_of, processor_time
from page_link import PageLink
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage
from tool_link import ToolLink

PERIOD = 0.1  # s between messages
ANSWERS = 30  # of another page meanwhile, over a second at least
LONGEST_TEXT = 45_000  # letters
SOON = 15.0  # s in which another page is answered meanwhile, also on a busy machine


class Talker:
    """Publishes one message again and again until it is stopped."""

    def __init__(self, topic, message):
        self._publisher = rospy.Publisher(topic, type(message), queue_size=1)
        self._timer = rospy.Timer(rospy.Duration(PERIOD),
                                  lambda _: self._publisher.publish(message))

    def stop(self):
        self._timer.shutdown()
        self._timer.join()
        self._publisher.unregister()


def packed(message):
    """As bytes."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def ready(message):
    """It is packed once: to pack millions of numbers holds up all that is timed here meanwhile."""
    packet, kind = packed(message), type(message)
    return type(kind.__name__, (kind,), {"serialize": lambda self, out: out.write(packet)})()


def unpacking_time(message):
    """s of a processor until it is Python's own numbers, which nobody needs to show it."""
    packet, began = packed(message), time.process_time()
    type(message)().deserialize(packet)
    return time.process_time() - began


def picture():
    return Image(width=32, height=24, encoding="bgr8", step=96, data=bytes(96 * 24))


class Messages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.url = wait_until(lambda: rospy.get_param("/sim_viewer/url", ""), "the page's address")

    def setUp(self):
        self.link = ToolLink(self.url)
        self.addCleanup(self.link.close)

    def talk(self, topic, message):
        talker = Talker(topic, message)
        self.addCleanup(talker.stop)
        wait_until(lambda: topic in dict(rosgraph.Master("/m").getPublishedTopics("/")), topic)
        time.sleep(1.1)  # what the page knows of the master may be a second old
        return talker

    def echo(self, topic):
        watched = self.link.watch("echo", topic=topic)
        data = watched.until(lambda data: True, f"a message of {topic}")
        watched.stop()
        return data

    def test_one_topic_is_watched_in_every_way_in_any_order(self):
        for first in ("image", "echo"):
            topic = f"/{first}_first"
            self.talk(topic, picture())
            pages = PageLink(self.url), ToolLink(self.url)
            for page in pages:
                self.addCleanup(page.close)
            if first == "image":
                self.watch_picture(pages[0], topic)
            echo = pages[1].watch("echo", topic=topic)
            echo.until(lambda data: "text" in data and "width: 32" in data["text"], "its text")
            plot = pages[1].watch("plot", paths=[f"{topic}/width"])
            plot.until(lambda data: next(iter(data.values()))[0][1] == 32, "its width")
            rate = pages[1].watch("rate", topic=topic)
            rate.until(lambda data: 5 < data["rate"] < 15, "its rate")
            if first != "image":
                self.watch_picture(pages[0], topic)

    def watch_picture(self, page, topic):
        self.assertTrue(page.ask("watch", what="image", args={"topic": topic})["ok"])
        wait_until(lambda: page.events, "a picture")
        self.assertIsInstance(page.events[0], bytes, page.events[0])

    def test_frames_are_seen_by_the_tree_while_their_messages_are_read(self):
        frame = TransformStamped(child_frame_id="base")
        frame.header.frame_id, frame.transform.rotation.w = "odom", 1.0
        self.talk("/tf", TFMessage([frame]))
        echo = self.link.watch("echo", topic="/tf")
        tree = self.link.watch("tf")
        tree.until(lambda rows: [row["frame"] for row in rows] == ["odom", "base"], "the tree")
        echo.until(lambda data: 'child_frame_id: "base"' in data["text"], "its messages")

    def test_huge_messages_are_cut_and_hold_nobody_up(self):
        grid = OccupancyGrid(data=np.full(4000 * 4000, 7, np.int8).tobytes())
        cloud = PointCloud2(width=500_000, height=1, point_step=16, data=bytes(8_000_000))
        neighbour, server = ToolLink(self.url), process_of("/sim_viewer")
        self.addCleanup(neighbour.close)
        limit = unpacking_time(grid) / 2
        for topic, message, count in (("/map", grid, 16_000_000), ("/cloud", cloud, 8_000_000)):
            talker = self.talk(topic, ready(message))
            watched = self.link.watch("echo", topic=topic)
            waits = [self.wait_for_answer(neighbour, server) for _ in range(ANSWERS)]
            longest, work = np.max(waits, axis=0)
            text = watched.until(lambda data: True, topic)["text"]
            watched.stop()
            talker.stop()
            print(f"{topic}: another page waits for {longest:.2f} s, {work:.3f} s of work")
            self.assertIn(f"# ... {count} in all", text)
            self.assertLess(len(text), LONGEST_TEXT)
            self.assertLess(longest, SOON)
            self.assertLess(work, limit)

    def wait_for_answer(self, page, server):
        """How long an answer takes, and how long processors work for the server until then; s."""
        time.sleep(PERIOD / 3)
        began, worked = time.monotonic(), processor_time(server)
        page.data("about")
        return time.monotonic() - began, processor_time(server) - worked

    def test_a_type_that_is_not_built_here_is_said(self):
        master = rosgraph.Master("/stranger")
        master.registerPublisher("/strange", "no_such_package/Thing", "http://localhost:1")
        self.addCleanup(master.unregisterPublisher, "/strange", "http://localhost:1")
        time.sleep(1.1)
        for what in ("echo", "rate"):
            error = self.link.error("watch", what=what, args={"topic": "/strange"})
            self.assertIn("no_such_package/Thing, which is not built here", error)

    def test_a_topic_that_goes_and_comes_again(self):
        talker = self.talk("/fleeting", Float64(1.0))
        watched = self.link.watch("echo", topic="/fleeting")
        watched.until(lambda data: data["text"] == "data: 1.0", "the first talker")
        talker.stop()
        self.talk("/fleeting", Float64(2.0))
        watched.until(lambda data: data["text"] == "data: 2.0", "the second talker")


if __name__ == "__main__":
    rospy.init_node("messages", disable_rostime=True)
    rostest.rosrun("sim_viewer", "messages", Messages, sys.argv)

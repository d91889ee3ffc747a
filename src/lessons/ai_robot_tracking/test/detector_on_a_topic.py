#!/usr/bin/env python3
"""object_detector.py on a topic of drawn pictures: what it publishes, skips, says and refuses."""

import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import numpy as np
import rospy
import rostest
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image, LaserScan
from vision_msgs.msg import Detection2DArray, VisionInfo

NODE, TOPIC = "/object_detector", "/any/image_topic"
LIMIT = 60.0  # wall s
QUIET_TIME = 5.0  # wall s without an image, until the node says why
HELD_RATE = 5.0  # pictures a second that the node may look at


class Detector(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found, cls.drawn, cls.shown, cls.infos, cls.said = [], [], [], [], []
        cls.changed = threading.Condition()
        cls.camera = rospy.Publisher(TOPIC, Image, queue_size=1)
        for topic, kind, heard in ((f"{NODE}/detections", Detection2DArray, cls.found),
                                   (f"{NODE}/annotated", Image, cls.drawn),
                                   (f"{NODE}/windows/YOLO_Detection", Image, cls.shown),
                                   (f"{NODE}/vision_info", VisionInfo, cls.infos),
                                   ("/rosout", Log, cls.said)):
            rospy.Subscriber(topic, kind, cls.hear, heard)
        cls.wait(lambda: cls.camera.get_num_connections() and cls.infos, "the node")

    @classmethod
    def hear(cls, message, heard):
        with cls.changed:
            heard.append(message)
            cls.changed.notify_all()

    @classmethod
    def wait(cls, condition, what):
        with cls.changed:
            until = time.monotonic() + LIMIT
            while not condition():
                if time.monotonic() > until:
                    raise AssertionError(f"{what}: not within {LIMIT:.0f} s")
                cls.changed.wait(0.05)

    def answer(self, message):
        """What the node publishes for this picture; sent again until it answers."""
        self.repeat(message, lambda: self.answers(message), "an answer")
        return self.answers(message)[0]

    def answers(self, message):
        return [found for found in self.found if found.header.stamp == message.header.stamp]

    def repeat(self, message, condition, what):
        """Send a picture until something is so."""
        until = time.monotonic() + LIMIT
        while not condition():
            self.assertLess(time.monotonic(), until, f"{what}: not within {LIMIT:.0f} s")
            self.camera.publish(message)
            time.sleep(0.1)

    def heard(self, text):
        return any(text in line.msg and line.name == NODE for line in self.said)

    def test_finds_the_patch_under_the_pictures_header(self):
        found = self.answer(picture(101, patch=(64, 128)))
        self.assertEqual(found.header.frame_id, "camera")
        (one,) = found.detections
        self.assertEqual(one.results[0].id, 0)
        self.assertGreater(one.results[0].score, 0.8)
        self.assertAlmostEqual(one.bbox.center.x, 96, delta=0.01)
        self.assertAlmostEqual(one.bbox.size_y, 64, delta=0.01)
        names = rospy.get_param(self.infos[0].database_location)
        self.assertEqual(names[one.results[0].id], "red")
        self.wait(lambda: any(d.header.stamp.secs == 101 for d in self.drawn), "annotated")
        drawn = next(d for d in self.drawn if d.header.stamp.secs == 101)
        self.assertEqual((drawn.width, drawn.height, drawn.encoding), (256, 192, "rgb8"))
        self.wait(lambda: self.shown, "a picture in the window")
        self.assertEqual((self.shown[0].width, self.shown[0].encoding), (256, "bgr8"))

    def test_wrong_and_empty_pictures_are_said_and_it_goes_on(self):
        wrong = picture(201, patch=(64, 128))
        wrong.encoding = "yuv422"
        self.repeat(wrong, lambda: self.heard("encoding 'yuv422' is not among"), "a complaint")
        empty = picture(202)
        self.assertEqual(self.answer(empty).detections, [])
        self.repeat(empty, lambda: self.heard("one colour all over"), "a word on the empty picture")
        found = self.answer(picture(203, patch=(0, 64)))
        self.assertEqual(len(found.detections), 1)

    def test_only_the_newest_pictures_are_looked_at(self):
        began, last = time.monotonic(), 300
        while time.monotonic() - began < 2.0 or not self.heard("images skipped in"):
            self.assertLess(time.monotonic() - began, LIMIT, "nothing said of what was skipped")
            last += 1
            self.camera.publish(picture(last, patch=(64, 128)))
            time.sleep(0.02)
        self.wait(lambda: self.found and self.found[-1].header.stamp.secs == last, "the last one")
        looked = [f for f in self.found if 300 < f.header.stamp.secs <= last]
        self.assertLessEqual(len(looked), (time.monotonic() - began) * HELD_RATE + 2)

    def test_a_topic_of_another_type_is_said_once(self):
        network = Path(__file__).resolve().parent / "detection_data" / "patches_v8.onnx"
        scans = rospy.Publisher("/scan", LaserScan, queue_size=1, latch=True)
        scans.publish(LaserScan())
        node = subprocess.Popen(
            ["rosrun", "ai_robot_tracking", "object_detector.py", "__name:=other_type",
             f"_model:={network}", "image:=/scan"])
        try:
            self.wait(lambda: self.lines_of("/other_type", "no image"), "the reason")
            time.sleep(2 * QUIET_TIME)  # in which it would be said again
        finally:
            node.kill()
            node.wait()
            scans.unregister()
        (line,) = self.lines_of("/other_type", "no image")
        self.assertIn("it carries messages of type sensor_msgs/LaserScan. Topics with images: ",
                      line)
        self.assertIn(TOPIC, line)

    def lines_of(self, node, text):
        """What a node has said with this text."""
        return [line.msg for line in self.said if line.name == node and text in line.msg]

    def test_a_wrong_model_ends_the_node_with_one_line(self):
        with tempfile.NamedTemporaryFile(suffix=".onnx") as file:
            file.write(b"no network")
            file.flush()
            said = self.refused(f"_model:={file.name}")
        self.assertIn("is damaged, or no ONNX file", said)
        self.assertTrue(Path(file.name).name in said)
        self.assertFalse(rospy.has_param("/second/model"), "it would stay for the next run")

    def test_a_number_for_a_name_ends_the_node_with_one_line(self):
        self.assertIn("~config must be a name, not 5", self.refused("_config:=5"))

    def test_a_window_that_is_neither_true_nor_false_ends_the_node_with_one_line(self):
        self.assertIn("~window must be true or false, not 5", self.refused("_window:=5"))

    def test_a_name_that_is_no_topic_ends_the_node_with_one_line(self):
        self.assertIn("'/my camera' cannot be a topic", self.refused("_image:=my camera"))

    def refused(self, argument):
        done = subprocess.run(
            ["rosrun", "ai_robot_tracking", "object_detector.py", "__name:=second", argument],
            capture_output=True, text=True, timeout=60, check=False)
        self.assertNotEqual(done.returncode, 0)
        said = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        self.assertEqual(len(said), 1, said)
        return said[0]

    def test_a_low_rate_does_not_keep_ctrl_c_waiting(self):
        network = Path(__file__).resolve().parent / "detection_data" / "patches_v8.onnx"
        node = subprocess.Popen(
            ["rosrun", "ai_robot_tracking", "object_detector.py", "__name:=slow",
             "_max_rate:=0.01", f"_model:={network}", f"image:={TOPIC}"])
        heard = []
        subscriber = rospy.Subscriber("/slow/detections", Detection2DArray, heard.append)
        try:
            # It answers the first picture alone, also where it has no subscriber yet.
            self.wait(lambda: has_subscriber("/slow", "/slow/detections"), "the node's answers")
            self.repeat(picture(401), lambda: heard, "an answer at a low rate")
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(timeout=LIMIT), 0)
        finally:
            subscriber.unregister()
            node.kill()
            node.wait()


def has_subscriber(node, topic):
    """Whether the node knows of one; rospy's subscriber says it is connected a moment earlier."""
    try:
        uri = rospy.get_master().lookupNode(node)[2]
        return any(entry[2:5:2] == ["o", topic] for entry in ServerProxy(uri).getBusInfo(NODE)[2])
    except OSError:
        return False


def picture(second, patch=None):
    """256 x 192 px, grey, with a red patch in a row of cells from one column to another."""
    pixels = np.full((192, 256, 3), 90, np.uint8)
    if patch:
        pixels[32:96, patch[0]:patch[1]] = (0, 0, 255)  # red, as bgr8
    message = Image(height=192, width=256, encoding="bgr8", step=768, data=pixels.tobytes())
    message.header.stamp, message.header.frame_id = rospy.Time(second), "camera"
    return message


if __name__ == "__main__":
    rospy.init_node("detector_on_a_topic")
    rostest.rosrun("ai_robot_tracking", "detector", Detector, sys.argv)

#!/usr/bin/env python3
"""The programs, one class after another: the frames' tree, and then pictures republished."""

import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from cv_bridge import CvBridge
from roslib.packages import find_node
from sensor_msgs.msg import CompressedImage, Image

LIMIT = 60.0  # s


class DrawsFrames(unittest.TestCase):
    """view_frames as pages type it, and the other programs of tf beside it."""

    def view_frames(self, folder, *words):
        return subprocess.run(["rosrun", "tf", "view_frames", *words], cwd=folder, text=True,
                              capture_output=True, timeout=LIMIT, check=False)

    def test_the_tree_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.view_frames(folder)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("frames.pdf generated", done.stdout)
            self.assertTrue(Path(folder, "frames.pdf").read_bytes().startswith(b"%PDF"))
            graph = Path(folder, "frames.gv").read_text(encoding="utf-8")
            self.assertIn('"base" -> "arm"', graph)
            self.assertIn('"arm" -> "hand"', graph)

    def test_a_folder_that_cannot_be_written_is_one_line(self):
        done = self.view_frames("/proc")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1))
        self.assertIn("frames.gv", done.stderr)

    def test_debians_other_programs_are_found(self):
        for name in ("tf_echo", "tf_monitor", "tf_remap", "static_transform_publisher"):
            self.assertTrue(find_node("tf", name))
        done = subprocess.run(["rosrun", "tf", "tf_echo"], capture_output=True, text=True,
                              timeout=LIMIT, check=False)
        self.assertIn("tf_echo source_frame target_frame", done.stdout)


BRIDGE = CvBridge()
COLOURS = np.zeros((20, 30, 3), np.uint8)
COLOURS[..., 2], COLOURS[:10, :, 0] = 200, 100
METRES = np.linspace(0.5, 5, 600, dtype=np.float32).reshape(20, 30)
METRES[0, 0] = np.nan


def kind(transport):
    return Image if transport == "raw" else CompressedImage


class Republish(unittest.TestCase):
    """republish as the wiki types it: what comes out is what went in."""

    def start(self, source, target, incoming, outgoing):
        words = [word for word in (source, f"in:={incoming}", target, f"out:={outgoing}") if word]
        program = subprocess.Popen([find_node("image_transport", "republish")[0], *words])
        self.addCleanup(program.wait)
        self.addCleanup(program.terminate)

    def through(self, image, transport):
        """`image` republished as `transport`, and back: that message, and the image again."""
        name = self.id().rpartition(".")[2]
        base = f"/{name}"
        self.start("raw", transport, base, f"{base}_there")
        self.start(transport, "raw", f"{base}_there", f"{base}_back")
        found, done = {}, threading.Event()

        def keep(message, which):
            found[which] = message
            if len(found) == 2:
                done.set()

        rospy.Subscriber(f"{base}_there/{transport}", CompressedImage, keep, "there")
        rospy.Subscriber(f"{base}_back", Image, keep, "back")
        publisher = rospy.Publisher(base, Image, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: publisher.publish(image))
        self.addCleanup(timer.shutdown)
        self.assertTrue(done.wait(LIMIT), f"only {list(found)} came")
        self.assertEqual(found["back"].header.frame_id, image.header.frame_id)
        return found["there"], found["back"]

    def image(self, array, encoding):
        image = BRIDGE.cv2_to_imgmsg(array, encoding)
        image.header.frame_id = "eye"
        return image

    def test_colours(self):
        there, back = self.through(self.image(COLOURS, "rgb8"), "compressed")
        self.assertEqual(there.format, "rgb8; jpeg compressed bgr8")
        self.assertEqual(back.encoding, "rgb8")
        found = BRIDGE.imgmsg_to_cv2(back, "passthrough").astype(int)
        self.assertLess(np.abs(found - COLOURS).mean(), 4)

    def test_depth(self):
        there, back = self.through(self.image(METRES, "32FC1"), "compressedDepth")
        self.assertEqual(there.format[:6], "32FC1;")
        found = BRIDGE.imgmsg_to_cv2(back, "passthrough")
        self.assertTrue(np.isnan(found[0, 0]))
        self.assertLess(np.nanmax(np.abs(found - METRES)), 0.01)

    def test_data_that_are_no_picture_are_one_line(self):
        rospy.Subscriber("/bad_out", Image, id)
        publisher = rospy.Publisher("/bad/compressedDepth", CompressedImage, queue_size=1)
        for data in (b"", bytes(12)):
            program = subprocess.Popen(["rosrun", "image_transport", "republish",
                                        "compressedDepth", "in:=/bad", "raw", "out:=/bad_out"],
                                       stderr=subprocess.PIPE, text=True)
            self.addCleanup(program.stderr.close)
            self.addCleanup(program.wait)
            self.addCleanup(program.terminate)
            message = CompressedImage(format="32FC1; compressedDepth png", data=data)
            timer = rospy.Timer(rospy.Duration(0.2), lambda _, one=message: publisher.publish(one))
            self.assertRegex(program.stderr.readline(), "republish: .*buf")
            timer.shutdown()
            program.terminate()

    def test_without_a_target_it_publishes_all(self):
        self.start("raw", None, "/all", "/all_out")
        publisher = rospy.Publisher("/all", Image, queue_size=1)
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: publisher.publish(
            self.image(COLOURS[..., 0], "mono8")))
        self.addCleanup(timer.shutdown)
        for transport, name in (("raw", "/all_out"), ("compressed", "/all_out/compressed")):
            self.assertTrue(rospy.wait_for_message(name, kind(transport), LIMIT))

    def test_an_unknown_transport_is_one_line(self):
        done = subprocess.run(["rosrun", "image_transport", "republish", "compresed", "in:=/a"],
                              capture_output=True, text=True, timeout=LIMIT, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, "^republish: there is no transport 'compresed' here; there "
                         "are .*compressed, .*raw.*\n$")


if __name__ == "__main__":
    rospy.init_node("programs_story")
    rostest.rosrun("debian_programs", "programs", "__main__", sys.argv)

#!/usr/bin/env python3
"""map_server and map_saver as processes: a round trip bit for bit, and a line for each mistake."""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from nav_msgs.msg import MapMetaData
from nav_msgs.msg import OccupancyGrid as Map
from nav_msgs.srv import GetMap, LoadMap
from rosgraph_msgs.msg import Clock
from roslib.packages import find_node

from map_server.map_files import read_map, write_map
from nav_algorithms.cells import OccupancyGrid

LIMIT = 60.0  # s
CELLS = np.random.default_rng(3).choice(np.array([-1, 0, 100], np.int8), (60, 90))


class RoundTrip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        clock = rospy.Publisher("/clock", Clock, queue_size=1)
        cls.running = threading.Event()

        def tick():
            while not rospy.is_shutdown():
                if cls.running.is_set():
                    clock.publish(rospy.Time(7, 5))
                time.sleep(0.05)

        threading.Thread(target=tick, daemon=True).start()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        write_map(self.folder / "one", OccupancyGrid(CELLS, 0.025, (-1 / 3, 2.0)), yaw=0.5)
        self.running.set()

    def start(self, program, *arguments):
        command = [find_node("map_server", program)[0], *map(str, arguments)]
        process = subprocess.Popen(command, text=True, cwd=self.folder, start_new_session=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()

    def serve(self):
        server = self.start("map_server", "one.yaml", "_frame_id:=floor")
        rospy.wait_for_service("/static_map", LIMIT)
        return server

    def fails(self, code, said, *command):
        process = self.start(*command)
        output, _ = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, code, output)
        self.assertIn(said, output)
        lines = [line for line in output.splitlines() if "[INFO]" not in line]
        self.assertEqual(len(lines), 1, output)

    def assert_same(self, first, second):
        """All but the number of the message, which each way of asking counts for itself."""
        first.header.seq = second.header.seq
        self.assertEqual(first, second)

    def test_served_saved_and_read_again(self):
        server = self.serve()
        served = rospy.wait_for_message("/map", Map, LIMIT)
        self.assertEqual((served.header.frame_id, served.header.stamp), ("floor", rospy.Time(7, 5)))
        self.assertEqual(served.info.map_load_time, rospy.Time(7, 5))
        self.assertEqual(np.array(served.data, np.int8).tobytes(), CELLS.tobytes())
        self.assertAlmostEqual(2 * np.arctan2(served.info.origin.orientation.z,
                                              served.info.origin.orientation.w), 0.5)
        self.assertEqual(rospy.wait_for_message("/map_metadata", MapMetaData, LIMIT), served.info)
        self.assert_same(rospy.ServiceProxy("/static_map", GetMap)().map, served)

        saver = self.start("map_saver", "-f", "two")
        output, _ = saver.communicate(timeout=LIMIT)
        self.assertEqual(saver.returncode, 0, output)
        self.assertEqual(*((self.folder / f"{name}.pgm").read_bytes() for name in ("one", "two")))
        (first, yaw), (again, same_yaw) = (read_map(self.folder / f"{name}.yaml")
                                           for name in ("one", "two"))
        self.assertEqual((again.resolution, again.origin), (first.resolution, first.origin))
        self.assertAlmostEqual(yaw, same_yaw, places=12)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["one.pgm", "one.yaml", "two.pgm", "two.yaml"])
        os.killpg(server.pid, signal.SIGTERM)
        output, _ = server.communicate(timeout=LIMIT)
        self.assertNotIn("Traceback", output)

    def test_change_map_says_by_its_result_what_was_wrong(self):
        self.serve()
        change = rospy.ServiceProxy("/change_map", LoadMap)
        write_map(self.folder / "other", OccupancyGrid(CELLS[:10], 0.1, (0.0, 0.0)))
        answer = change(str(self.folder / "other.yaml"))
        self.assertEqual((answer.result, answer.map.info.height), (answer.RESULT_SUCCESS, 10))
        self.assert_same(rospy.wait_for_message("/map", Map, LIMIT), answer.map)
        (self.folder / "bad.yaml").write_text("image: other.pgm\n")
        (self.folder / "other.pgm").write_bytes(b"P5")
        for name, result in (("none.yaml", answer.RESULT_MAP_DOES_NOT_EXIST),
                             ("bad.yaml", answer.RESULT_INVALID_MAP_METADATA),
                             ("other.yaml", answer.RESULT_INVALID_MAP_DATA)):
            self.assertEqual(change(str(self.folder / name)).result, result)
        self.assert_same(rospy.ServiceProxy("/static_map", GetMap)().map, answer.map)

    def test_an_image_and_its_resolution(self):
        self.start("map_server", "one.pgm", "0.025")
        served = rospy.wait_for_message("/map", Map, LIMIT)
        self.assertEqual(np.array(served.data, np.int8).tobytes(), CELLS.tobytes())
        self.assertEqual((served.header.frame_id, served.info.origin.position.x), ("map", 0.0))

    def test_it_waits_for_the_clock(self):
        self.running.clear()
        server = self.start("map_server", "one.yaml")
        said = next(line for line in server.stdout if "no simulated clock /clock for" in line)
        self.assertIn("use_sim_time", said)
        with self.assertRaises(rospy.ROSException):
            rospy.wait_for_service("/static_map", 0.5)
        self.running.set()
        rospy.wait_for_service("/static_map", LIMIT)

    def test_mistakes_of_map_server(self):
        text = (self.folder / "one.yaml").read_text()
        for name, old, new in (("image", "one.pgm", "none.pgm"), ("size", "0.025", "wide"),
                               ("cut", "one.pgm", "cut.pgm")):
            (self.folder / f"{name}.yaml").write_text(text.replace(old, new))
        (self.folder / "cut.pgm").write_bytes((self.folder / "one.pgm").read_bytes()[:-1])
        for said, command in (("no.yaml: there is no such file", ["no.yaml"]),
                              ("none.pgm: there is no such image", ["image.yaml"]),
                              ("resolution is 'wide', but must be a number", ["size.yaml"]),
                              ("cut.pgm: is not an image, or a damaged one", ["cut.yaml"]),
                              ("'1e-46' is not a resolution", ["one.pgm", "1e-46"]),
                              ("got 0 arguments; usage", []),
                              ("frame_id is 3, but must be", ["one.yaml", "_frame_id:=3"])):
            self.fails(255, said, "map_server", *command)

    def test_mistakes_of_map_saver(self):
        for said, arguments in (("there is no such folder", ["-f", "no/map"]),
                                ("--free 70 must be below --occ 65", ["--free", "70"]),
                                ("'x' is not a whole number", ["--occ", "x"]),
                                ("unrecognized arguments: map.pgm", ["map.pgm"])):
            self.fails(1, said, "map_saver", *arguments)

    def test_map_saver_says_what_it_waits_for_and_takes_another_topic(self):
        saver = self.start("map_saver", "map:=/elsewhere", "-f", self.folder / "three")
        said = next(line for line in saver.stdout if "no map on /elsewhere for" in line)
        self.assertIn("nobody publishes there", said)
        publisher = rospy.Publisher("/elsewhere", Map, queue_size=1, latch=True)
        message = Map(data=[0, 100])
        message.info.width, message.info.height, message.info.resolution = 2, 1, 0.05
        publisher.publish(message)
        self.assertEqual(saver.wait(LIMIT), 0)
        self.assertEqual(read_map(self.folder / "three.yaml")[0].cells.tolist(), [[0, 100]])

    def test_a_map_that_is_none_is_not_saved(self):
        publisher = rospy.Publisher("/broken", Map, queue_size=1, latch=True)
        message = Map(data=[0, 100])
        message.info.width, message.info.height, message.info.resolution = 2, 2, 0.05
        publisher.publish(message)
        self.fails(1, "a map of 2 x 2 cells came with 2", "map_saver", "map:=/broken")


if __name__ == "__main__":
    rospy.init_node("round_trip_story")
    rostest.rosrun("map_server", "round_trip", RoundTrip, sys.argv)

#!/usr/bin/env python3
"""Both styles of costmap through their life: silence, a map, sensors, changes, silence again."""

import struct
import sys
import time
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import PolygonStamped, TransformStamped
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import LaserScan, PointCloud2, PointField

PATIENCE = 60.0  # s
RESOLUTION = 0.1


class CostmapStory(unittest.TestCase):
    """A robot at (2, 2) in a room of 6 m x 4 m with a pillar, whose odometry began at (1, 1)."""

    def setUp(self):
        self.lines, self.grids, self.outlines, self.subscribers = [], {}, {}, {}
        rospy.Subscriber("/rosout", Log, lambda message: self.lines.append(message.msg))
        for name in ("global", "local"):
            self.subscribers[name] = rospy.Subscriber(f"/{name}/costmap/costmap", OccupancyGrid,
                                                      self.take, name)
            rospy.Subscriber(f"/{name}/costmap/costmap_updates", OccupancyGridUpdate, self.change,
                             name)
            rospy.Subscriber(f"/{name}/costmap/footprint", PolygonStamped, self.outline, name)
        self.scans = rospy.Publisher("/scan", LaserScan, queue_size=1)
        self.clouds = rospy.Publisher("/points", PointCloud2, queue_size=1)
        self.maps = rospy.Publisher("/map", OccupancyGrid, queue_size=1, latch=True)
        self.frames = tf2_ros.TransformBroadcaster()
        self.range, self.silent = 1.02, False
        rospy.Timer(rospy.Duration(0.1), self.sense)

    def take(self, message, name):
        self.grids[name] = (np.array(message.data, np.int8).reshape(message.info.height, -1),
                            message)

    def change(self, message, name):
        if name in self.grids:
            part = np.array(message.data, np.int8).reshape(message.height, message.width)
            self.grids[name][0][message.y:message.y + message.height,
                                message.x:message.x + message.width] = part

    def outline(self, message, name):
        self.outlines[name] = message.polygon.points

    def sense(self, _event):
        stamp = rospy.Time.now()
        for parent, child in (("map", "odom"), ("odom", "base")):
            moved = TransformStamped(child_frame_id=child)
            moved.header.frame_id, moved.header.stamp = parent, stamp
            moved.transform.translation.x = moved.transform.translation.y = 1.0
            moved.transform.rotation.w = 1.0
            self.frames.sendTransform(moved)
        if self.silent:
            return
        scan = LaserScan(angle_min=0.0, angle_increment=0.01, range_min=0.1, range_max=5.0,
                         ranges=[self.range] * 3)
        cloud = PointCloud2(height=1, width=1, point_step=12, row_step=12,
                            data=struct.pack("<fff", 0.02, self.range, 0.5),
                            fields=[PointField(axis, 4 * n, PointField.FLOAT32, 1)
                                    for n, axis in enumerate("xyz")])
        for message, publisher in ((scan, self.scans), (cloud, self.clouds)):
            message.header.frame_id, message.header.stamp = "base", stamp
            publisher.publish(message)

    def wait(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what}; lines: {self.lines[-5:]}")
            time.sleep(0.05)

    def at(self, name, x, y):
        """What is published for a place, m; None before the first grid."""
        if name not in self.grids:
            return None
        cells, message = self.grids[name]
        origin, resolution = message.info.origin.position, message.info.resolution
        return cells[int((y - origin.y) / resolution), int((x - origin.x) / resolution)]

    def test_story(self):
        self.wait(lambda: any("no map on /map" in line for line in self.lines), "no map: no line")
        self.assertNotIn("global", self.grids)

        cells = np.zeros((40, 60), np.int8)
        cells[10, 45], cells[0, 0] = 100, -1
        room = OccupancyGrid(data=cells.ravel().tolist())
        room.header.frame_id = "map"
        room.info.width, room.info.height, room.info.resolution = 60, 40, RESOLUTION
        room.info.origin.orientation.w = 1.0
        self.maps.publish(room)
        self.wait(lambda: self.at("global", 4.55, 1.05) == 100, "the pillar is missing")
        self.assertEqual(self.at("global", 0.05, 0.05), -1)
        self.assertEqual(self.at("global", 4.65, 1.05), 99)
        self.assertTrue(0 < self.at("global", 4.95, 1.05) < 99)
        self.wait(lambda: self.at("global", 3.05, 2.05) == 100, "the laser marks nothing")
        self.wait(lambda: len(self.outlines.get("global", ())) == 16, "no outline")

        self.wait(lambda: self.at("local", 1.02, 2.02) == 100, "the cloud marks nothing")
        info = self.grids["local"][1].info
        self.assertEqual((info.width, info.height), (60, 60))
        self.assertAlmostEqual(info.origin.position.x, -0.5, delta=0.051)
        corner = self.outlines["local"][0]
        self.assertAlmostEqual(corner.x, 1.21, places=4)
        self.assertAlmostEqual(corner.y, 1.11, places=4)

        self.subscribers["global"].unregister()
        self.range = 1.52
        self.wait(lambda: self.at("global", 3.05, 2.05) < 99, "the laser clears nothing")
        self.take(rospy.wait_for_message("/global/costmap/costmap", OccupancyGrid, PATIENCE),
                  "global")  # who comes late gets the newest
        self.assertLess(self.at("global", 3.05, 2.05), 99)
        self.assertEqual(self.at("global", 3.55, 2.05), 100)

        soft = Client("/global/costmap/soft", timeout=PATIENCE)
        soft.update_configuration({"inflation_radius": 0.0})
        self.wait(lambda: self.at("global", 4.65, 1.05) == 0, "the inflation stays")
        Client("/global/costmap/lasers", timeout=PATIENCE).update_configuration({"enabled": False})
        self.wait(lambda: self.at("global", 3.55, 2.05) == 0, "the obstacle stays")
        Client("/local/costmap", timeout=PATIENCE).update_configuration({"footprint_padding": 0.1})
        self.wait(lambda: abs(self.outlines["local"][0].x - 1.3) < 1e-4, "padding")

        self.silent = True
        self.wait(lambda: any("no LaserScan on /scan" in line and "every 1 s" in line
                              for line in self.lines), "a silent laser: no line")


if __name__ == "__main__":
    rospy.init_node("costmap_story")
    rostest.rosrun("costmap_2d", "costmap_story", CostmapStory, sys.argv)

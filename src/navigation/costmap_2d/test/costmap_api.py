#!/usr/bin/env python3
"""CostmapROS as move_base uses it: snapshots, forgetting, pausing, stopping, freshness."""

import sys
import time
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Point32, TransformStamped
from sensor_msgs.msg import PointCloud

from costmap_2d import CostmapROS
from nav_algorithms.costmap.costs import LETHAL
from nav_nodes.missing_data import MissingData
from nav_nodes.transforms import Transforms

PATIENCE = 60.0  # s


def wait_until(condition, what):
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(what)
        time.sleep(0.02)


class CostmapApi(unittest.TestCase):
    """A robot at (5, 0) with obstacles 0.5 m and 1.5 m in front of it."""

    def setUp(self):
        self.clouds = rospy.Publisher("/points", PointCloud, queue_size=1)
        self.frames = tf2_ros.TransformBroadcaster()
        self.located, self.seeing, self.obstacles = False, True, (0.55, 1.55)
        rospy.Timer(rospy.Duration(0.05), self.sense)
        missing_data = MissingData()
        self.costmap = CostmapROS("local_costmap", Transforms(missing_data), missing_data)

    def sense(self, _event):
        stamp = rospy.Time.now()
        if self.located:
            moved = TransformStamped(child_frame_id="base_link")
            moved.header.frame_id, moved.header.stamp = "map", stamp
            moved.transform.translation.x = 5.0
            moved.transform.rotation.w = 1.0
            self.frames.sendTransform(moved)
        if self.seeing:
            cloud = PointCloud(points=[Point32(x, 0.05, 0.2) for x in self.obstacles])
            cloud.header.frame_id, cloud.header.stamp = "base_link", stamp
            self.clouds.publish(cloud)

    def marks(self):
        """x, m, of the obstacles in a snapshot."""
        found = self.costmap.snapshot()
        return np.round(found.centres_of(np.argwhere(found.cells == LETHAL))[:, 0], 2).tolist()

    def test_api(self):
        costmap = self.costmap
        self.assertEqual(costmap.layer_names(), ["obstacle_layer", "inflation_layer"])
        self.assertEqual((costmap.bare_footprint.shape, costmap.footprint.shape),
                         ((16, 2), (16, 2)))
        self.assertAlmostEqual(costmap.footprint[0, 0], 0.21)  # the radius is searched upwards
        self.assertFalse(costmap.is_ready())
        self.assertIsNone(costmap.robot_pose())
        self.assertFalse(costmap.update())
        self.assertFalse(costmap.clear_area(1.0))

        self.located = True
        wait_until(costmap.is_ready, "it is ready")
        wait_until(lambda: len(self.marks()) == 2, "two obstacles")
        wait_until(lambda: costmap.robot_pose() is not None, "a pose")
        self.assertEqual(costmap.robot_pose().tolist(), [5.0, 0.0, 0.0])
        wait_until(costmap.is_current, "all is current")
        costmap.snapshot().cells[:] = 7
        self.assertEqual(len(self.marks()), 2)

        costmap.pause()
        time.sleep(0.3)
        self.obstacles = ()
        time.sleep(0.3)
        self.assertEqual(len(self.marks()), 2)
        costmap.resume()
        self.assertTrue(costmap.clear_area(2.0, ["static_layer"]))
        wait_until(lambda: costmap.clear_area(2.0) and len(self.marks()) == 1,
                   "what is far is forgotten")  # again if an old cloud was still on its way
        self.assertLess(self.marks()[0], 6.0)
        self.assertTrue(costmap.clear_area(2.0, ["obstacle_layer"], invert=True))
        wait_until(lambda: not self.marks(), "what is near is forgotten")

        self.obstacles = (0.55, 1.55)
        wait_until(lambda: len(self.marks()) == 2, "they are seen again")
        self.obstacles = ()
        wait_until(lambda: costmap.reset_layers() or not self.marks(), "a reset forgets everything")

        self.seeing = False
        wait_until(lambda: not costmap.is_current(), "the sensor is overdue")
        self.seeing = True
        wait_until(costmap.is_current, "the sensor is there again")
        self.located = False
        wait_until(lambda: costmap.robot_pose() is None, "the pose is too old")
        wait_until(lambda: not costmap.is_current(), "updates are overdue")
        self.located = True
        wait_until(costmap.is_current, "the pose is there again")
        costmap.stop()
        self.assertFalse(costmap.is_ready())
        wait_until(lambda: not self.clouds.get_num_connections(), "it goes on listening")
        costmap.start()
        wait_until(costmap.is_current, "it starts again")


if __name__ == "__main__":
    rospy.init_node("costmap_api")
    rostest.rosrun("costmap_2d", "costmap_api", CostmapApi, sys.argv)

#!/usr/bin/env python3
"""A scan becomes a cloud and the cloud a scan, in the frame that was asked for."""

import math
import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import LaserScan

LIMIT = 60.0  # s, for whatever is waited for


class ThereAndBack(unittest.TestCase):
    def test_there_and_back(self):
        first = LaserScan(angle_min=-math.pi, angle_increment=math.pi / 180, range_max=5.0)
        first.header.frame_id = "mast"
        first.ranges = [math.inf] * 360
        first.ranges[90], first.ranges[270] = 2.0, 3.0
        scans = rospy.Publisher("/first_scan", LaserScan, queue_size=1)

        def send(_):
            first.header.stamp = rospy.Time.now()
            scans.publish(first)

        timer = rospy.Timer(rospy.Duration(0.1), send)
        scan = rospy.wait_for_message("/scan", LaserScan, LIMIT)
        timer.shutdown()
        self.assertEqual(scan.header.frame_id, "base")
        seen = {round(scan.angle_min + i * scan.angle_increment, 1): r
                for i, r in enumerate(scan.ranges) if math.isfinite(r)}
        self.assertEqual({angle: round(r, 3) for angle, r in seen.items()},
                         {-1.6: 2.0, 1.6: 3.0})


if __name__ == "__main__":
    rospy.init_node("there_and_back")
    rostest.rosrun("pointcloud_to_laserscan", "there_and_back", ThereAndBack, sys.argv)

#!/usr/bin/env python3
"""A scan goes through a chain whose filters need tf."""

import math
import sys
import threading
import unittest

import rospy
import rostest
from sensor_msgs.msg import LaserScan

LIMIT = 60.0  # s


class FilteredScans(unittest.TestCase):
    def test_the_robot_and_what_is_far_are_left_out(self):
        came, seen = threading.Event(), []

        def take(scan):
            seen.append(scan)
            came.set()

        publisher = rospy.Publisher("/scan", LaserScan, queue_size=1)
        rospy.Subscriber("/scan_filtered", LaserScan, take, queue_size=1)
        scan = LaserScan(angle_min=0.0, angle_increment=math.pi, angle_max=3 * math.pi,
                         range_min=0.01, range_max=10.0, ranges=[1.0, 0.1, 7.0, 2.0],
                         intensities=[1.0, 2.0, 3.0, 4.0])
        scan.header.frame_id = "laser"
        end = rospy.get_time() + LIMIT
        while not came.wait(0.2):
            self.assertLess(rospy.get_time(), end, "no filtered scan")
            scan.header.stamp = rospy.Time.now()
            publisher.publish(scan)
        found = seen[0]
        self.assertEqual([math.isnan(one) for one in found.ranges], [False, True, True, False])
        self.assertEqual((found.ranges[0], found.ranges[3]), (1.0, 2.0))
        self.assertEqual(found.intensities, (1.0, 2.0, 3.0, 4.0))
        self.assertAlmostEqual(found.angle_max, 3 * math.pi, 4)
        self.assertEqual(found.header.frame_id, "laser")


if __name__ == "__main__":
    rospy.init_node("filtered_scans")
    rostest.rosrun("laser_filters", "filtered_scans", FilteredScans, sys.argv)

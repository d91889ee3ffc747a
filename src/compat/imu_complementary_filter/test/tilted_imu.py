#!/usr/bin/env python3
"""The node says how an IMU is tilted that was never told."""

import math
import sys
import threading
import unittest

import rospy
import rostest
from sensor_msgs.msg import Imu

LIMIT = 60.0  # s


class TiltedImu(unittest.TestCase):
    def test_roll(self):
        came, seen = threading.Event(), []

        def take(imu):
            seen.append(imu)
            came.set()

        publisher = rospy.Publisher("/imu/data_raw", Imu, queue_size=1)
        rospy.Subscriber("/imu/data", Imu, take, queue_size=1)
        imu = Imu()
        imu.header.frame_id = "imu_link"
        imu.linear_acceleration.y, imu.linear_acceleration.z = (9.81 * math.sin(0.4),
                                                                9.81 * math.cos(0.4))
        end = rospy.get_time() + LIMIT
        while not came.wait(0.1):
            self.assertLess(rospy.get_time(), end, "nothing comes")
            imu.header.stamp = rospy.Time.now()
            publisher.publish(imu)
        turn = seen[-1].orientation
        self.assertAlmostEqual(2 * math.atan2(turn.x, turn.w), 0.4, 2)
        self.assertEqual(seen[-1].header.frame_id, "imu_link")


if __name__ == "__main__":
    rospy.init_node("tilted_imu")
    rostest.rosrun("imu_complementary_filter", "tilted_imu", TiltedImu, sys.argv)

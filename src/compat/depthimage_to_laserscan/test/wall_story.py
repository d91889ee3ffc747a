#!/usr/bin/env python3
"""A wall of a depth camera comes out as a scan, from the node that stands for the nodelet."""

import sys
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import CameraInfo, Image, LaserScan

LIMIT = 60.0  # s, for whatever is waited for


class Wall(unittest.TestCase):
    def test_a_wall_two_metres_ahead(self):
        info = CameraInfo(width=64, height=48, P=[50, 0, 32, 0, 0, 50, 24, 0, 0, 0, 1, 0])
        image = Image(width=64, height=48, encoding="32FC1", step=256,
                      data=np.full((48, 64), 2.0, np.float32).tobytes())
        image.header.frame_id = "optical"
        infos = rospy.Publisher("/camera/depth/camera_info", CameraInfo, queue_size=1)
        images = rospy.Publisher("/camera/depth/image_raw", Image, queue_size=1)

        def send(_):
            image.header.stamp = info.header.stamp = rospy.Time.now()
            infos.publish(info)
            images.publish(image)

        timer = rospy.Timer(rospy.Duration(0.1), send)
        scan = rospy.wait_for_message("/scan", LaserScan, LIMIT)
        timer.shutdown()
        self.assertEqual((scan.header.frame_id, len(scan.ranges)), ("laser", 64))
        self.assertEqual((round(scan.range_min, 4), scan.range_max), (0.45, 4.0))
        self.assertAlmostEqual(min(r for r in scan.ranges if r == r), 2.0, places=3)


if __name__ == "__main__":
    rospy.init_node("wall")
    rostest.rosrun("depthimage_to_laserscan", "wall", Wall, sys.argv)

#!/usr/bin/env python3
"""The tutorial's velocity moves the whole car in tf, and its wheels turn."""

import sys
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Twist

LIMIT = rospy.Duration(60.0)


class Car(unittest.TestCase):
    def test_the_car_drives_and_its_wheels_turn(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        start = buffer.lookup_transform("odom", "laser", rospy.Time(0), LIMIT).transform
        self.assertAlmostEqual(start.translation.z, 0.055 + 0.115 + 0.1, places=6)
        wheel = buffer.lookup_transform("base_link", "left_wheel", rospy.Time(0), LIMIT).transform
        self.assertAlmostEqual(wheel.translation.y, 0.1)
        publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=1, latch=True)
        command = Twist()
        command.linear.x, command.angular.z = 0.2, 0.5
        publisher.publish(command)
        end = rospy.Time.now() + LIMIT
        moved = start
        while rospy.Time.now() < end and moved.translation.y < 0.05:
            rospy.sleep(0.1)
            moved = buffer.lookup_transform("odom", "laser", rospy.Time(0)).transform
        self.assertGreater(moved.translation.x, 0.1)
        self.assertGreater(moved.translation.y, 0.05)  # to the left
        self.assertGreater(moved.rotation.z, 0.0)
        turned = buffer.lookup_transform("base_link", "left_wheel", rospy.Time(0)).transform
        self.assertNotAlmostEqual(turned.rotation.y, wheel.rotation.y, places=3)
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("arbotix_drives_the_car")
    rostest.rosrun("urdf01_rviz", "arbotix_drives", Car, sys.argv)

#!/usr/bin/env python3
"""Wheels that do not notice a turn, an IMU that does: pose, transform and status of the node."""

import math
import sys
import threading
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from robot_pose_ekf.srv import GetStatus
from sensor_msgs.msg import Imu

LIMIT = 60.0  # s


class WheelsAndImu(unittest.TestCase):
    def setUp(self):
        self.arrived, self.newest, self.count = threading.Condition(), None, 0
        rospy.Subscriber("/robot_pose_ekf/odom_combined", PoseWithCovarianceStamped, self.keep)
        self.odometry = rospy.Publisher("/odom", Odometry, queue_size=5)
        self.imu = rospy.Publisher("/imu_data", Imu, queue_size=5)

    def keep(self, message):
        with self.arrived:
            self.newest = message
            self.count += 1
            self.arrived.notify_all()

    def publish(self, x, yaw):
        odometry, imu = Odometry(), Imu()
        odometry.header.stamp = imu.header.stamp = rospy.Time.now()
        odometry.header.frame_id, odometry.child_frame_id = "odom", "base_footprint"
        odometry.pose.pose.position.x, odometry.pose.pose.orientation.w = x, 1.0
        odometry.pose.covariance = [1e-3 if i % 7 == 0 else 0.0 for i in range(36)]
        imu.header.frame_id = "imu_link"
        imu.orientation.z, imu.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        self.odometry.publish(odometry)
        self.imu.publish(imu)

    def until(self, x, yaw, condition, what):
        end = rospy.get_time() + LIMIT
        while self.newest is None or not condition(self.newest.pose.pose):
            self.assertLess(rospy.get_time(), end, f"{what}; the newest is {self.newest}")
            self.publish(x, yaw)
            with self.arrived:
                self.arrived.wait(0.05)

    def test_the_imu_turns_the_pose_and_the_wheels_move_it(self):
        self.until(0.0, 1.0, lambda pose: abs(pose.orientation.z) < 0.01, "it begins at yaw 0")
        rospy.wait_for_service("/robot_pose_ekf/get_status", LIMIT)
        status = rospy.ServiceProxy("/robot_pose_ekf/get_status", GetStatus)
        self.until(0.0, 1.0, lambda pose: "imu on /imu_data: is used, is active" in status().status,
                   "no IMU; a turn before its first message would not be noticed")
        heard = self.count
        self.until(0.0, 1.0, lambda pose: self.count > heard + 5, "no more poses")
        self.until(0.0, 1.0 + math.pi / 2, lambda pose: pose.orientation.z > 0.7, "no turn")
        self.until(1.0, 1.0 + math.pi / 2, lambda pose: abs(pose.position.y - 1.0) < 0.02,
                   "no metre to the left")
        # a z of 0.7 is 1.15 degrees short of the turn, 0.02 m aside after a metre
        self.assertLess(abs(self.newest.pose.pose.position.x), 0.03)
        self.assertEqual(self.newest.header.frame_id, "odom_combined")
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        end = rospy.get_time() + LIMIT
        while not buffer.can_transform("odom_combined", "imu_link", rospy.Time(0)):
            self.assertLess(rospy.get_time(), end, "no transform")
            self.publish(1.0, 1.0 + math.pi / 2)
            with self.arrived:
                self.arrived.wait(0.05)
        listener.unregister()
        lines = status().status
        self.assertIn("odom on /odom: is used, is active", lines)
        self.assertIn("vo on /vo: is used, is not active, received 0 messages", lines)
        self.assertIn("gps on /gps: is not used", lines)


if __name__ == "__main__":
    rospy.init_node("wheels_and_imu")
    rostest.rosrun("robot_pose_ekf", "wheels_and_imu", WheelsAndImu, sys.argv)

#!/usr/bin/env python3
"""Speed from wheels and turning from an IMU become a pose, a transform, and a new start."""

import math
import sys
import threading
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

LIMIT = 60.0  # s, for whatever is waited for
SPEED, RATE = 0.4, 0.5  # m/s, rad/s


class WheelsAndImu(unittest.TestCase):
    def setUp(self):
        self.changed, self.last = threading.Condition(), None
        rospy.Subscriber("/odometry/filtered", Odometry, self.on_odometry)
        wheels = rospy.Publisher("/wheels", Odometry, queue_size=1)
        imus = rospy.Publisher("/imu/data", Imu, queue_size=1)
        odometry, imu = Odometry(child_frame_id="base_link"), Imu()
        odometry.header.frame_id, imu.header.frame_id = "odom", "imu_link"
        odometry.twist.twist.linear.x, imu.angular_velocity.z = SPEED, RATE
        odometry.twist.covariance = [1e-4 if i % 7 == 0 else 0.0 for i in range(36)]
        imu.angular_velocity_covariance = [1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-4]

        def send(_):
            odometry.header.stamp = imu.header.stamp = rospy.Time.now()
            wheels.publish(odometry)
            imus.publish(imu)

        self.timer = rospy.Timer(rospy.Duration(0.04), send)

    def tearDown(self):
        self.timer.shutdown()

    def on_odometry(self, odometry):
        with self.changed:
            self.last = odometry
            self.changed.notify_all()

    def wait_for(self, condition, what):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: self.last and condition(self.last),
                                                  LIMIT), what)
            return self.last

    def test_pose_transform_and_set_pose(self):
        def yaw(odometry):
            turn = odometry.pose.pose.orientation
            return 2.0 * math.atan2(turn.z, turn.w)

        found = self.wait_for(lambda o: yaw(o) > 0.6, "turning")
        self.assertEqual((found.header.frame_id, found.child_frame_id), ("odom", "base_link"))
        self.assertAlmostEqual(found.twist.twist.linear.x, SPEED, delta=0.02)
        self.assertAlmostEqual(found.twist.twist.angular.z, RATE, delta=0.02)
        radius = SPEED / RATE  # on a circle whose centre is to the left of the start
        place = found.pose.pose.position
        self.assertAlmostEqual(math.hypot(place.x, place.y - radius), radius, delta=0.05)
        self.assertAlmostEqual(place.z, 0.0, places=4)
        self.assertGreater(found.pose.covariance[0], 0.0)

        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        buffer.lookup_transform("odom", "base_link", rospy.Time(0), rospy.Duration(LIMIT))
        listener.unregister()

        start = PoseWithCovarianceStamped()
        start.header.frame_id = "odom"
        start.pose.pose.position.x, start.pose.pose.orientation.w = 50.0, 1.0
        publisher = rospy.Publisher("/set_pose", PoseWithCovarianceStamped, queue_size=1,
                                    latch=True)
        publisher.publish(start)
        self.wait_for(lambda o: o.pose.pose.position.x > 49.0, "the pose that was set")


if __name__ == "__main__":
    rospy.init_node("wheels_and_imu")
    rostest.rosrun("robot_localization", "wheels_and_imu", WheelsAndImu, sys.argv)

#!/usr/bin/env python3
"""Commands in; odometry, joint states and tf out; and it stands when nobody commands any more."""

import math
import statistics
import sys
import threading
import unittest
from itertools import pairwise

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

LIMIT = 60.0  # s, for whatever is waited for


class DriveWithoutWorld(unittest.TestCase):
    def setUp(self):
        self.commands = rospy.Publisher("/cmd_vel", Twist, queue_size=10)
        self.seen, self.arrived = [], threading.Condition()
        self.subscriber = rospy.Subscriber("/odom", Odometry, self.keep)

    def tearDown(self):
        self.subscriber.unregister()

    def keep(self, odometry):
        with self.arrived:
            self.seen.append(odometry)
            self.arrived.notify_all()

    def wait_for(self, condition, what):
        with self.arrived:
            came = self.arrived.wait_for(lambda: self.seen and condition(self.seen[-1]), LIMIT)
        self.assertTrue(came, what)
        return self.seen[-1]

    def drive(self, linear, angular, until, what):
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        timer = rospy.Timer(rospy.Duration(0.1), lambda _: self.commands.publish(message))
        try:
            return self.wait_for(until, what)
        finally:
            timer.shutdown()

    def test_it_goes_as_told_and_stands_a_second_after(self):
        # conforms: turtlebot3_fake_node, turtlebot3_fake_node/cmd_vel, turtlebot3_fake_node/odom
        first = self.wait_for(lambda _: True, "odometry").pose.pose.position.x
        moving = self.drive(0.2, 0.5, lambda o: o.pose.pose.position.x > first + 0.1, "motion")
        self.assertAlmostEqual(moving.twist.twist.linear.x, 0.2)
        self.assertAlmostEqual(moving.twist.twist.angular.z, 0.5)
        self.assertEqual((moving.header.frame_id, moving.child_frame_id),
                         ("odom", "base_footprint"))
        self.assertEqual([moving.pose.covariance[i] for i in (0, 7, 14, 21, 28, 35)],
                         [0.1, 0.1, 1e6, 1e6, 1e6, 0.2])
        self.wait_for(lambda o: o.twist.twist.linear.x == 0.0, "a stop")
        stopped = self.seen[-1].header.stamp
        last_moving = max(o.header.stamp for o in self.seen if o.twist.twist.linear.x)
        self.assertLess((stopped - last_moving).to_sec(), 0.2)

    def test_rate_is_30_hz(self):
        with self.arrived:
            self.arrived.wait_for(lambda: len(self.seen) > 60, LIMIT)
        stamps = [o.header.stamp.to_sec() for o in self.seen]
        period = statistics.median(b - a for a, b in pairwise(stamps))  # some may come late
        self.assertAlmostEqual(1 / period, 30.0, delta=2.0)

    def test_wheels_and_frames(self):
        # conforms: turtlebot3_fake_node/joint_states, turtlebot3_fake_node/tb3_model
        self.drive(0.0, 1.0, lambda o: o.twist.twist.angular.z > 0.99, "motion")
        state = rospy.wait_for_message("/joint_states", JointState, LIMIT)
        self.assertEqual(state.name, ["wheel_left_joint", "wheel_right_joint"])
        # A waffle's, half of 0.287 m; without the parameter it would be a burger.
        self.assertAlmostEqual(state.velocity[1], 0.1435 / 0.033)
        self.assertAlmostEqual(state.velocity[0], -0.1435 / 0.033)
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        found = buffer.lookup_transform("odom", "wheel_left_link", rospy.Time(0),
                                        rospy.Duration(LIMIT)).transform.translation
        self.assertAlmostEqual(found.z, 0.033, delta=0.001)
        self.assertTrue(math.isfinite(found.x))
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("drive_without_world")
    rostest.rosrun("turtlebot3_fake", "fake", DriveWithoutWorld, sys.argv)

#!/usr/bin/env python3
"""wheel_odometry.py: a made-up drive comes out as odometry and as a transform."""

import math
import os
import signal
import sys
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
import tf2_ros
from fake_controllers import wait_until
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState

WHEELBASE, TRACK, WHEEL_RADIUS = 0.335, 0.23, 0.05  # m
JOINTS = ["left_rear_axle", "right_rear_axle", "left_steering_joint", "right_steering_joint"]
PERIOD, STEPS = 0.02, 50  # s, of a drive
ENDING = 2.0  # s


def hinges_of(radius):
    """Angles, rad, of both hinges on a circle of the rear axle's middle, m; left is positive."""
    return [math.atan(WHEELBASE / (radius - side * TRACK / 2)) for side in (1, -1)]


class Story(unittest.TestCase):
    """In the order of the names: each drive begins where the last one ended."""

    @classmethod
    def setUpClass(cls):
        cls.odometry, cls.lines = [], []
        cls.transforms = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.transforms)
        cls.states = rospy.Publisher("/racecar/joint_states", JointState, queue_size=100)
        rospy.Subscriber("odom", Odometry, cls.odometry.append)
        rospy.Subscriber("/rosout", Log, lambda line: cls.lines.append(line.msg))
        wait_until(cls.states.get_num_connections, "wheel_odometry")
        cls.time = 100.0  # s
        cls.angles = [0.0, 0.0]  # rad, of the rear wheels

    def tell(self, ways, hinges, names=JOINTS):
        """One message; the rear wheels have rolled so far since the last, m."""
        type(self).time += PERIOD
        for i, way in enumerate(ways):
            self.angles[i] += way / WHEEL_RADIUS
        message = JointState(name=names, position=[*self.angles, *hinges][:len(names)])
        message.header.stamp = rospy.Time(self.time)
        self.states.publish(message)

    def drive(self, way, hinges, turn=0.0):
        """In STEPS of PERIOD; m forwards and rad to the left."""
        for _ in range(STEPS):
            self.tell([(way + side * turn * TRACK / 2) / STEPS for side in (-1, 1)], hinges)
            wait_until(lambda: self.odometry[-1].header.stamp.to_sec() > self.time - 1e-6,
                       "odometry")  # step by step: the queue of the node holds ten

    def assert_at(self, x, y, yaw):
        pose = self.odometry[-1].pose.pose
        self.assertAlmostEqual(pose.position.x, x, places=3)
        self.assertAlmostEqual(pose.position.y, y, places=3)
        self.assertAlmostEqual(2 * math.atan2(pose.orientation.z, pose.orientation.w), yaw,
                               places=3)

    def test_1_straight_on(self):
        wait_until(lambda: self.tell([0, 0], [0, 0]) or self.odometry, "the link to odom")
        self.drive(0.5, [0, 0])
        self.assert_at(0.5, 0, 0)
        last = self.odometry[-1]
        self.assertAlmostEqual(last.twist.twist.linear.x, 0.5 / (STEPS * PERIOD), places=4)
        self.assertEqual((last.header.frame_id, last.child_frame_id), ("odom", "base_link"))
        self.assertTrue(all(last.pose.covariance[i] > 0 for i in (0, 7, 35)))

    def test_2_a_quarter_of_a_circle_to_the_left_and_the_transform(self):
        hinges = hinges_of(1.0)
        self.tell([0, 0], hinges)  # what was steered between two messages counts half
        self.drive(math.pi / 2, hinges, math.pi / 2)
        self.assert_at(1.5, 1.0, math.pi / 2)
        now = rospy.Time(self.time)
        wait_until(lambda: self.transforms.can_transform("odom", "base_link", now),
                   "the transform of the same moment")
        found = self.transforms.lookup_transform("odom", "base_link", rospy.Time(0)).transform
        self.assertEqual(found.translation.x, self.odometry[-1].pose.pose.position.x)
        self.assertEqual(found.rotation, self.odometry[-1].pose.pose.orientation)

    def test_3_backwards(self):
        self.tell([0, 0], [0, 0])
        self.drive(-0.4, [0, 0])
        self.assert_at(1.5, 0.6, math.pi / 2)
        self.assertLess(self.odometry[-1].twist.twist.linear.x, -0.3)

    def test_4_a_message_without_the_hinges_is_one_line_and_no_motion(self):
        count = len(self.odometry)
        for _ in range(5):
            self.tell([0.1, 0.1], [], JOINTS[:2])
        wait_until(lambda: any("no angle of left_steering_joint, right_steering_joint on "
                               "/racecar/joint_states" in line for line in self.lines), "a line")
        self.assertEqual(len(self.odometry), count)
        self.assertEqual(sum("no angle of" in line for line in self.lines), 1)

    def test_5_it_ends_at_once(self):
        node = rosgraph.Master("/story").lookupNode("/wheel_odometry")
        pid = xmlrpc.client.ServerProxy(node).getPid("/story")[2]
        os.kill(pid, signal.SIGINT)
        wait_until(lambda: self.states.get_num_connections() == 0, "its end", ENDING)


if __name__ == "__main__":
    rospy.init_node("wheel_odometry_story")
    rostest.rosrun("car_control", "wheel_odometry", Story, sys.argv)

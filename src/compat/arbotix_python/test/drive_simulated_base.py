#!/usr/bin/env python3
"""The tutorial's 0.2 m/s and 0.5 rad/s make a circle of 0.4 m in odom, tf and joint_states."""

import math
import subprocess
import sys
import threading
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from roslib.packages import find_node
from sensor_msgs.msg import JointState

LIMIT = 60.0  # s, for whatever is waited for
DRIVER = (find_node("arbotix_python", "arbotix_driver")[0],)
RADIUS = 0.2 / 0.5


def yaw(pose):
    return 2 * math.atan2(pose.orientation.z, pose.orientation.w)


class SimulatedBase(unittest.TestCase):
    def setUp(self):
        self.came, self.odometry, self.joints = threading.Condition(), None, None
        rospy.Subscriber("/odom", Odometry, lambda message: self.keep("odometry", message))
        rospy.Subscriber("/joint_states", JointState, lambda message: self.keep("joints", message))
        self.command = rospy.Publisher("/cmd_vel", Twist, queue_size=1, latch=True)

    def keep(self, name, message):
        with self.came:
            setattr(self, name, message)
            self.came.notify_all()

    def wait_for(self, condition, what):
        with self.came:
            self.assertTrue(self.came.wait_for(condition, LIMIT), what)

    def drive(self, speed, turn):
        message = Twist()
        message.linear.x, message.angular.z = speed, turn
        self.command.publish(message)

    def test_circle_then_stop(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        self.drive(0.2, 0.5)
        self.wait_for(lambda: self.odometry and yaw(self.odometry.pose.pose) > 1.0, "a turn")
        pose, twist = self.odometry.pose.pose, self.odometry.twist.twist
        self.assertEqual((self.odometry.header.frame_id, self.odometry.child_frame_id),
                         ("odom", "base_footprint"))
        self.assertEqual((twist.linear.x, twist.angular.z), (0.2, 0.5))
        self.assertAlmostEqual(pose.position.x, RADIUS * math.sin(yaw(pose)), places=6)
        self.assertAlmostEqual(pose.position.y, RADIUS * (1 - math.cos(yaw(pose))), places=6)
        self.assertEqual(self.joints.name, ["left_wheel2base_link", "right_wheel2base_link"])
        self.assertAlmostEqual(self.joints.velocity[0], 0.15 / 0.0325)
        self.assertGreater(self.joints.position[1], self.joints.position[0])
        self.drive(0.0, 0.0)
        self.wait_for(lambda: self.odometry.twist.twist.linear.x == 0.0, "standing")
        stood = self.odometry
        self.wait_for(lambda: self.odometry is not stood, "the next odometry")
        self.assertEqual(self.odometry.pose, stood.pose)
        transform = buffer.lookup_transform("odom", "base_footprint", stood.header.stamp,
                                            rospy.Duration(LIMIT))
        self.assertEqual(transform.transform.translation.x, stood.pose.pose.position.x)
        listener.unregister()

    def refusal(self, *parameters):
        done = subprocess.run((*DRIVER, "__name:=second", *parameters), text=True, check=False,
                              capture_output=True, timeout=LIMIT)
        self.assertEqual(done.returncode, 1, done.stderr)
        return done.stderr

    def test_what_it_cannot_do_is_one_line(self):
        self.assertIn("set the node's parameter sim to true", self.refusal())
        self.assertIn("no controllers", self.refusal("_sim:=true"))
        self.assertIn("no controllers", self.refusal("_sim:=true", "_controllers:=5"))
        wrong = "_controllers:={base: {type: omni_controller}}"
        self.assertIn("only diff_controller", self.refusal("_sim:=true", wrong))
        right = "_controllers:={base: {type: diff_controller, base_width: 0.2, ticks_meter: 2000}}"
        said = self.refusal("_sim:=true", right, "_read_rate:=0")
        self.assertIn("read_rate is 0: it must be a number above 0", said)


if __name__ == "__main__":
    rospy.init_node("drive_simulated_base")
    rostest.rosrun("arbotix_python", "driver", SimulatedBase, sys.argv)

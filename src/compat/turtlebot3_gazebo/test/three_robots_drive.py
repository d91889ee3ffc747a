#!/usr/bin/env python3
"""Three robots in one house: each has its topics, its frames and its own wheels."""

import sys
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

LIMIT = 60.0  # s, for whatever is waited for
STARTS = {"tb3_0": (-7.0, -1.0), "tb3_1": (7.0, -1.0), "tb3_2": (0.5, 3.0)}


def place(robot):
    at = rospy.wait_for_message(f"/{robot}/odom", Odometry, LIMIT).pose.pose.position
    return at.x, at.y


class ThreeRobots(unittest.TestCase):
    def test_each_stands_at_its_place(self):
        for robot, (x, y) in STARTS.items():
            odometry = rospy.wait_for_message(f"/{robot}/odom", Odometry, LIMIT)
            self.assertEqual(odometry.header.frame_id, f"{robot}/odom")
            self.assertEqual(odometry.child_frame_id, f"{robot}/base_footprint")
            self.assertAlmostEqual(odometry.pose.pose.position.x, x, delta=0.05)
            self.assertAlmostEqual(odometry.pose.pose.position.y, y, delta=0.05)

    def test_each_sees_by_its_own_laser(self):
        for robot in STARTS:
            scan = rospy.wait_for_message(f"/{robot}/scan", LaserScan, LIMIT)
            self.assertEqual(scan.header.frame_id, f"{robot}/base_scan")
            self.assertTrue(any(r < scan.range_max for r in scan.ranges), robot)

    def test_frames_from_odometry_to_laser(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        for robot, (x, _) in STARTS.items():
            found = buffer.lookup_transform(f"{robot}/odom", f"{robot}/base_scan", rospy.Time(0),
                                            rospy.Duration(LIMIT)).transform
            self.assertAlmostEqual(found.translation.x, x, delta=0.1)
            self.assertAlmostEqual(found.translation.z, 0.182, delta=0.005)
        listener.unregister()

    def test_one_command_moves_one_robot(self):
        command = Twist()
        command.linear.x = 0.2
        publisher = rospy.Publisher("/tb3_2/cmd_vel", Twist, queue_size=1, latch=True)
        publisher.publish(command)
        end = rospy.Time.now() + rospy.Duration(LIMIT)
        while place("tb3_2")[0] < 0.9 and rospy.Time.now() < end:
            pass
        publisher.publish(Twist())
        self.assertGreater(place("tb3_2")[0], 0.9)
        for robot in ("tb3_0", "tb3_1"):
            for now, before in zip(place(robot), STARTS[robot], strict=True):
                self.assertAlmostEqual(now, before, delta=0.05)


if __name__ == "__main__":
    rospy.init_node("three_robots_drive")
    rostest.rosrun("turtlebot3_gazebo", "multi_turtlebot3", ThreeRobots, sys.argv)

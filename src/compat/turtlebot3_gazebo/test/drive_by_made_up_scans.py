#!/usr/bin/env python3
"""Shows turtlebot3_drive walls that are not there and reads how it turns away from them."""

import math
import sys
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

LIMIT = 60.0  # s, for whatever is waited for
FORWARD, RIGHT, LEFT = (0.3, 0.0), (0.0, -1.5), (0.0, 1.5)


class DriveTest(unittest.TestCase):
    def setUp(self):
        self.told, self.arrived = [], threading.Condition()
        self.scan = rospy.Publisher("/scan", LaserScan, queue_size=1, latch=True)
        self.odometry = rospy.Publisher("/odom", Odometry, queue_size=1, latch=True)
        self.subscriber = rospy.Subscriber("/robot/cmd_vel", Twist, self.keep)

    def keep(self, message):
        with self.arrived:
            self.told.append((message.linear.x, message.angular.z))
            self.arrived.notify_all()

    def show(self, **walls):
        """All is clear but for these degrees from straight ahead: _0=0.5 is a wall at 0.5 m."""
        ranges = [math.inf] * 360
        for name, distance in walls.items():
            ranges[int(name[1:])] = distance
        self.scan.publish(LaserScan(ranges=ranges, range_min=0.12, range_max=3.5))

    def face(self, angle_deg):
        message = Odometry()
        message.pose.pose.orientation.z = math.sin(math.radians(angle_deg) / 2)
        message.pose.pose.orientation.w = math.cos(math.radians(angle_deg) / 2)
        self.odometry.publish(message)

    def wait_until_told(self, command):
        with self.arrived:
            came = self.arrived.wait_for(lambda: self.told and self.told[-1] == command, LIMIT)
        self.assertTrue(came, f"{command} was not told; the last was {self.told[-1:]}")

    def next_commands(self, count):
        with self.arrived:
            self.told.clear()
            self.arrived.wait_for(lambda: len(self.told) >= count, LIMIT)
            return list(self.told)

    def test_turns_away_across_the_seam_of_the_angles(self):
        # conforms: turtlebot3_drive, turtlebot3_drive/cmd_vel_topic_name, turtlebot3_drive/scan
        # conforms: turtlebot3_drive/odom
        self.show()
        self.face(-170)
        self.wait_until_told(FORWARD)
        self.show(_0=0.5)
        self.wait_until_told(RIGHT)
        self.show(_330=0.5)
        self.face(170)  # 20 degrees on: the turn is not over
        self.assertEqual(set(self.next_commands(25)), {RIGHT})
        self.face(155)
        self.wait_until_told(LEFT)
        self.show()
        self.face(-174)
        self.wait_until_told(FORWARD)


if __name__ == "__main__":
    rospy.init_node("drive_by_made_up_scans")
    rostest.rosrun("turtlebot3_gazebo", "drive", DriveTest, sys.argv)

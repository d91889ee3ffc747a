#!/usr/bin/env python3
"""Navigation drives, the joystick takes over, a lock stops navigation."""

import sys
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from std_msgs.msg import Bool
from visualization_msgs.msg import Marker

LIMIT = 60.0  # s, for whatever is waited for


class TwoDrive(unittest.TestCase):
    def setUp(self):
        self.changed, self.seen = threading.Condition(), []
        rospy.Subscriber("/cmd_vel", Twist, self.on_command)
        self.sending = {}
        for topic, speed in (("/nav_vel", 0.1), ("/input_joy/cmd_vel", 0.9)):
            publisher = rospy.Publisher(topic, Twist, queue_size=1)
            command = Twist()
            command.linear.x = speed
            self.sending[topic] = False
            rospy.Timer(rospy.Duration(0.05), lambda _, t=topic, p=publisher, c=command:
                        self.sending[t] and p.publish(c))

    def on_command(self, command):
        with self.changed:
            self.seen.append(command.linear.x)
            self.changed.notify_all()

    def wait_for_five(self, speed):
        with self.changed:
            self.seen.clear()
            came = self.changed.wait_for(lambda: self.seen[-5:] == [speed] * 5, LIMIT)
            self.assertTrue(came, f"{speed} five times in a row; came: {self.seen}")

    def test_priorities_and_locks(self):
        self.sending["/nav_vel"] = True
        self.wait_for_five(0.1)
        self.sending["/input_joy/cmd_vel"] = True
        self.wait_for_five(0.9)
        arrow = rospy.wait_for_message("/marker", Marker, LIMIT)
        self.assertEqual((arrow.header.frame_id, arrow.type), ("base_footprint", Marker.ARROW))
        self.assertIn(arrow.points[1].x, (0.1, 0.9))
        self.sending["/input_joy/cmd_vel"] = False
        self.wait_for_five(0.1)
        lock = rospy.Publisher("/pause_navigation", Bool, queue_size=1, latch=True)
        lock.publish(True)
        with self.changed:
            while self.changed.wait(1.0):  # until nothing has come for a second
                pass
        lock.publish(False)
        self.wait_for_five(0.1)


if __name__ == "__main__":
    rospy.init_node("two_drive")
    rostest.rosrun("twist_mux", "two_drive", TwoDrive, sys.argv)

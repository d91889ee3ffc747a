#!/usr/bin/env python3
"""Simulated time has no say in how the turtle moves."""

import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from pond_watch import Topic, wait_until
from turtlesim.msg import Pose


class SimTimeStory(unittest.TestCase):
    def test_it_drives_and_stops_by_the_wall_clock(self):
        pose = Topic("/turtle1/pose", Pose)
        command = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        wait_until(lambda: command.get_num_connections(), "the command's connection")
        message = Twist()
        message.linear.x = 1.0
        command.publish(message)
        moving = pose.wait_for(lambda p: p.linear_velocity == 1.0, "moving")
        pose.wait_for(lambda p: p.x > moving.x + 0.5 and p.linear_velocity == 0, "standing")


if __name__ == "__main__":
    rospy.init_node("sim_time_story")
    rostest.rosrun("turtlesim", "sim_time_story", SimTimeStory, sys.argv)

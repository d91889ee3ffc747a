#!/usr/bin/env python3
"""Without lockstep the world goes on while a follower stands: the car stops, then drives on."""

import os
import signal
import time
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from gazebo_msgs.srv import GetModelState

LIMIT = 60.0  # s, wall
LONGEST = 0.5  # s, simulated, until the car stands
DRIVES, STANDS = 0.1, 0.01  # m/s


class PausedFollower(unittest.TestCase):
    def setUp(self):
        rospy.wait_for_service("/gazebo/get_model_state", LIMIT)
        self.ask = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)

    def wait_for(self, condition, what):
        """The simulated time, s, at which the car's speed (m/s) is so."""
        until = time.monotonic() + LIMIT
        while time.monotonic() < until:
            state = self.ask("turtlebot3_waffle", "")
            if state.success and condition(abs(state.twist.linear.x) + abs(state.twist.linear.y)):
                return state.header.stamp.to_sec()
            time.sleep(0.005)
        raise AssertionError(f"not within {LIMIT} s: {what}")

    def test_the_car_stands_within_half_a_second_and_drives_on(self):
        self.wait_for(lambda speed: speed > DRIVES, "the car drives")
        node = rosgraph.Master("/test").lookupNode("/follower")
        process = ServerProxy(node).getPid("/test")[2]
        self.addCleanup(os.kill, process, signal.SIGCONT)
        os.kill(process, signal.SIGSTOP)
        paused = self.ask("turtlebot3_waffle", "").header.stamp.to_sec()
        stood = self.wait_for(lambda speed: speed < STANDS, "the car stands")
        self.assertLess(stood - paused, LONGEST)
        os.kill(process, signal.SIGCONT)
        self.wait_for(lambda speed: speed > DRIVES, "the car drives on")


if __name__ == "__main__":
    rospy.init_node("paused_follower_stops_the_car", disable_rostime=True)
    rostest.rosrun("learning_topic", "paused_follower", PausedFollower)

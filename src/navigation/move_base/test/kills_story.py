#!/usr/bin/env python3
"""Each node named on the command line is killed while the robot drives, and is started again."""

import itertools
import os
import signal
import sys
import unittest

import actionlib
import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from made_up_robot import Robot
from move_base_msgs.msg import MoveBaseAction
from running import address, goal_at, pid_of, wait_until

HERE, THERE = (0.7, 0.7, 0.0), (1.9, 0.7, 0.0)
NODES = [word for word in rospy.myargv()[1:] if not word.startswith("-")]  # rostest adds some


class Kills(unittest.TestCase):
    """One after the other, on the way there and back."""

    def test_the_robot_stands_and_goes_on(self):
        """Stands within 1 s; arrives when the node is there again."""
        scan = "sweeps" if "laser" in NODES else "scan"
        self.robot = Robot(HERE, "odom", "scan", "tf", scan=scan)
        for node, place in zip(NODES, itertools.cycle((THERE, HERE))):
            self.drive_and_kill(node, place)

    def drive_and_kill(self, node, place):
        """To the place; the goal of a killed move_base is sent again."""
        client = self.client()
        client.send_goal(goal_at(place))
        wait_until(lambda: self.robot.velocity[0] > 0.1, "driving")
        before = address(node)
        os.kill(pid_of(node), signal.SIGKILL)
        wait_until(self.robot.stands, f"standing without {node}", 1.0)
        wait_until(lambda: address(node) not in (None, before), f"a new {node}")
        if node == "move_base":
            client = self.client()
            client.send_goal(goal_at(place))
        self.assertTrue(client.wait_for_result(rospy.Duration(100.0)), "it never arrives")
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED)
        self.assertLess(np.hypot(*(self.robot.pose[:2] - place[:2])), 0.15)
        self.assertTrue(self.robot.stands())

    def client(self):
        """Of the move_base that is there now."""
        found = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.assertTrue(found.wait_for_server(rospy.Duration(60.0)))
        return found


if __name__ == "__main__":
    rospy.init_node("kills")
    rostest.rosrun("move_base", "kills", Kills, sys.argv)

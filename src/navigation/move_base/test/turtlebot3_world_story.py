#!/usr/bin/env python3
"""Round a column to the other side, a cancelled goal, and a killed move_base."""

import os
import signal
import sys
import time
import unittest
import xmlrpc.client

import actionlib
import numpy as np
import rosgraph
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from gazebo_msgs.srv import GetModelState
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.msg import Odometry

from nav_algorithms.cells import OccupancyGrid
from nav_nodes.messages import grid_message, pose_of, stamped_pose

BEFORE, BEHIND = (-2.0, -0.5, 0.0), (-0.55, 0.55, 1.57)
COLUMNS = [(x, y) for x in (-1.1, 0.0, 1.1) for y in (-1.1, 0.0, 1.1)]
RADIUS = 0.15  # m


def columns() -> OccupancyGrid:
    """The columns of the world; its walls are far from here."""
    grid = OccupancyGrid(np.zeros((120, 120), np.int8), 0.05, (-3.0, -3.0))
    centres = grid.centres_of(np.stack(np.meshgrid(*2 * [np.arange(120)], indexing="ij"), -1))
    for column in COLUMNS:
        grid.cells[np.hypot(*np.moveaxis(centres - column, -1, 0)) <= RADIUS] = 100
    return grid


class Story(unittest.TestCase):
    """In this order."""

    def test_story(self):
        """By the simulator's own word of where the robot is."""
        maps = rospy.Publisher("map", OccupancyGridMessage, queue_size=1, latch=True)
        rospy.wait_for_message("scan", rospy.AnyMsg, 60)
        maps.publish(grid_message(columns(), "map", rospy.Time.now()))
        moving = []
        rospy.Subscriber("odom", Odometry, lambda odom: moving.append(
            abs(odom.twist.twist.linear.x) + abs(odom.twist.twist.angular.z)), queue_size=1)
        client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(60)))
        state = rospy.ServiceProxy("gazebo/get_model_state", GetModelState)

        client.send_goal(MoveBaseGoal(stamped_pose(np.array(BEHIND), "map", rospy.Time.now())))
        nearest = np.inf
        while not client.wait_for_result(rospy.Duration(0.2)):
            place = pose_of(state("turtlebot3_waffle", "").pose)
            nearest = min(nearest, *(np.hypot(*(place[:2] - column)) for column in COLUMNS))
            self.assertLess(rospy.get_time(), 100.0)
        self.assertEqual((client.get_state(), client.get_goal_status_text()),
                         (GoalStatus.SUCCEEDED, "Goal reached."))
        place = pose_of(state("turtlebot3_waffle", "").pose)
        self.assertLess(np.hypot(*(place[:2] - BEHIND[:2])), 0.1)
        self.assertLess(abs(place[2] - BEHIND[2]), 0.25)
        self.assertGreater(nearest, RADIUS + 0.1)

        for how in ("cancel", "kill"):
            client.send_goal(MoveBaseGoal(stamped_pose(np.array(BEFORE), "map", rospy.Time.now())))
            self.wait(lambda: moving[-1] > 0.1, "driving", 10.0)
            if how == "cancel":
                client.cancel_goal()
            else:
                node = rosgraph.Master("/story").lookupNode("/move_base")
                os.kill(xmlrpc.client.ServerProxy(node).getPid("/story")[2], signal.SIGKILL)
            self.wait(lambda: moving[-1] < 0.02, f"standing after {how}", 1.0)
            if how == "cancel":
                client.wait_for_result(rospy.Duration(5.0))
                self.assertEqual(client.get_state(), GoalStatus.PREEMPTED)

    def wait(self, condition, what, limit):
        """In simulated seconds."""
        end = rospy.get_time() + limit
        while not condition():
            self.assertLess(rospy.get_time(), end, what)
            time.sleep(0.02)


if __name__ == "__main__":
    rospy.init_node("story")
    rostest.rosrun("move_base", "turtlebot3_world_story", Story, sys.argv)

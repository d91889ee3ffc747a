#!/usr/bin/env python3
"""The simulator is killed while move_base drives: one line, and on in the next simulator."""

import os
import re
import signal
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from gazebo_msgs.srv import GetModelState, SpawnModel
from geometry_msgs.msg import Pose
from move_base_msgs.msg import MoveBaseAction
from rosgraph_msgs.msg import Log
from running import address, goal_at, pid_of, wait_until

HERE, THERE = (0.7, 0.7), (1.9, 0.7, 0.0)
ROBOT = "turtlebot3_waffle"
SILENT = 3.0  # s of wall time without a simulator


class KillsSimulator(unittest.TestCase):
    def setUp(self):
        self.lines, self.statuses = [], 0
        rospy.Subscriber("rosout", Log, self.note)
        rospy.Subscriber("move_base/status", GoalStatusArray, self.count)
        self.client = actionlib.ActionClient("move_base", MoveBaseAction)
        wait_until(lambda: self.client.wait_for_server(rospy.Duration(0.1)), "move_base")

    def note(self, message):
        # One of the two says that time stands.
        if message.name in ("/move_base", "/map_server") and message.level >= Log.WARN:
            self.lines.append((time.monotonic(), message.msg))

    def count(self, _message):
        self.statuses += 1

    def test_one_line_then_on_to_the_same_goal(self):
        wait_until(lambda: self.place() is not None, "the robot")
        goal = self.client.send_goal(goal_at(THERE))
        wait_until(lambda: self.place() and self.place().x > HERE[0] + 0.15, "driving")
        killed, before = time.monotonic(), address("gazebo")
        self.lines.clear()
        os.kill(pid_of("gazebo"), signal.SIGKILL)
        wait_until(lambda: self.lines and time.monotonic() > killed + SILENT, "a line")
        until = max(killed + SILENT, self.lines[0][0])  # a busy machine may say it later
        said = [line for when, line in self.lines if when <= until]
        self.assertEqual(len(said), 1, said)
        self.assertIn("no simulated clock /clock", said[0])
        wait_until(lambda: address("gazebo") not in (None, before), "a new simulator")
        self.spawn()
        wait_until(lambda: goal.get_goal_status() not in (GoalStatus.PENDING, GoalStatus.ACTIVE),
                   "the goal's end", 100.0)
        self.assertEqual(goal.get_goal_status(), GoalStatus.SUCCEEDED, goal.get_goal_status_text())
        self.assertLess(abs(self.place().x - THERE[0]), 0.15)
        told = self.statuses
        wait_until(lambda: self.statuses > told + 3, "the action's status, again and again")
        anew = [line for _, line in self.lines if re.search("clock was set back", line)]
        self.assertEqual(len(anew), 1, self.lines)

    def place(self):
        """Where the robot is in the simulator; None without either."""
        try:
            reply = rospy.ServiceProxy("gazebo/get_model_state", GetModelState)(ROBOT, "world")
        except (rospy.ServiceException, OSError):
            return None
        return reply.pose.position if reply.success else None

    def spawn(self):
        pose = Pose()
        pose.position.x, pose.position.y, pose.orientation.w = *HERE, 1.0
        rospy.wait_for_service("gazebo/spawn_urdf_model", 60.0)
        rospy.ServiceProxy("gazebo/spawn_urdf_model", SpawnModel)(
            ROBOT, rospy.get_param("robot_description"), "/", pose, "world")


if __name__ == "__main__":
    rospy.init_node("kills_simulator")
    rostest.rosrun("move_base", "kills_simulator", KillsSimulator)

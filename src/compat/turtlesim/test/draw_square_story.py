"""draw_square resets the pond and closes its square."""

import math
import re
import unittest

import rospy
from pond_watch import LogLines, Topic, start_node, wait_until
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

CLOSED_WITHIN = 0.02  # m
GOAL = re.compile(r"New goal \[(\S+) (\S+), (\S+)\]")
ROUND_LIMIT = 90.0  # s; one round takes 29


class DrawSquareStory(unittest.TestCase):
    def test_it_resets_and_drives_round(self):
        log, pose = LogLines(), Topic("/turtle1/pose", Pose)
        rospy.wait_for_service("/turtle1/teleport_absolute", 60.0)
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(1, 1, 1)
        node = start_node("draw_square")
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        log.wait_for_line("Resetting turtlesim.")
        start = pose.next()[0]
        self.assertAlmostEqual(start.x, 5.544445, places=5)

        def goals():
            found = [GOAL.fullmatch(line.msg) for line in log.messages]
            return [tuple(map(float, match.groups())) for match in found if match]

        wait_until(lambda: len(goals()) >= 9, "four sides and four turns", ROUND_LIMIT)
        for i, (x, y) in enumerate([(2, 0), (2, 2), (0, 2), (0, 0)]):
            corner = goals()[2 * i]
            self.assertLess(math.dist(corner[:2], (start.x + x, start.y + y)), 1e-3)
        home = goals()[7]  # the turn at the end of the fourth side begins where the turtle stands
        self.assertLess(math.dist(home[:2], (start.x, start.y)), CLOSED_WITHIN)
        self.assertTrue(any(line.msg == "Reached goal" for line in log.messages))
        self.assertEqual(max(p.linear_velocity for p in pose.messages), 1.0)
        self.assertAlmostEqual(max(p.angular_velocity for p in pose.messages), 0.4, places=6)

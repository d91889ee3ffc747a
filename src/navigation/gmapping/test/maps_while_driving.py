#!/usr/bin/env python3
"""Drives between the pillars and compares map and transform with what the simulator knows.

Parameters: ~origin (x, y), m: where in the world the map's frame begins (0, 0); ~size: cells of
the map's width (400); ~entropy: a topic on which gmapping's entropy must be above 0 (none).
"""

import math
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Twist
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap
from std_msgs.msg import Float64

from nav_nodes.messages import grid_of, pose_of

WAY = ((-1.65, -0.55), (-0.55, -0.55), (-0.55, 0.55))  # m, from (-2, -0.5)
PILLARS = ((-1.1, -1.1), (-1.1, 0.0), (0.0, 0.0), (0.0, -1.1))  # m, middles; seen from the way
RADIUS = 0.15  # m, theirs
LIMIT = 60.0   # s of wall time, for whatever is waited for


class MapsWhileDriving(unittest.TestCase):
    def setUp(self):
        self.arrived, self.got = threading.Condition(), {}
        self.origin = np.array(rospy.get_param("~origin", (0.0, 0.0)))
        self.entropy = rospy.get_param("~entropy", "")
        for topic, kind in (("/gazebo/model_states", ModelStates), ("/map", OccupancyGrid),
                            ("/map_metadata", MapMetaData), (self.entropy, Float64)):
            if topic:
                rospy.Subscriber(topic, kind, self.keep, topic, queue_size=1)
        self.commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self.buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(self.buffer)

    def keep(self, message, topic):
        with self.arrived:
            self.got[topic] = message
            self.arrived.notify_all()

    def until(self, condition, what):
        with self.arrived:
            self.assertTrue(self.arrived.wait_for(condition, LIMIT), f"no {what}")

    def truth(self):
        states = self.got["/gazebo/model_states"]
        return pose_of(states.pose[states.name.index("turtlebot3_waffle")])

    def estimate(self):
        at = self.buffer.lookup_transform("map", "base_footprint", rospy.Time(0)).transform
        return np.add(self.origin, (at.translation.x, at.translation.y))

    def drive_to(self, x, y):
        end = time.monotonic() + LIMIT
        while (left := np.array([x, y]) - self.truth()[:2]) @ left > 0.1**2:
            self.assertLess(time.monotonic(), end, f"({x}, {y}) is never reached")
            turn = math.remainder(math.atan2(left[1], left[0]) - self.truth()[2], math.tau)
            command = Twist()
            command.linear.x = 0.22 * max(0.0, 1 - abs(turn) / 0.6)
            command.angular.z = max(-0.9, min(0.9, 2 * turn))
            self.commands.publish(command)
            time.sleep(0.05)
        self.commands.publish(Twist())

    def test_map_and_pose_are_true(self):
        self.until(lambda: "/map" in self.got, "map before the robot has moved")
        self.until(lambda: "/gazebo/model_states" in self.got
                   and "turtlebot3_waffle" in self.got["/gazebo/model_states"].name, "robot")
        for place in WAY:
            self.drive_to(*place)
            rospy.sleep(0.7)
            off = np.hypot(*(self.estimate() - self.truth()[:2]))
            self.assertLess(off, 0.05, f"map to robot is {off:.3f} m off at {place}")
        old = self.got["/map"].header.stamp
        self.until(lambda: self.got["/map"].header.stamp > old, "newer map")
        self.map_is_true(grid_of(self.got["/map"]))
        size = rospy.get_param("~size", 400)
        self.assertEqual(self.got["/map_metadata"].width, size)
        if self.entropy:
            self.assertGreater(self.got[self.entropy].data, 0.0)
        answer = rospy.ServiceProxy("/dynamic_map", GetMap)().map
        self.assertEqual((answer.header.frame_id, answer.info.width), ("map", size))

    def map_is_true(self, grid):
        points = self.origin + grid.centres_of(np.argwhere(grid.cells == 100))
        for pillar in PILLARS:
            ways = np.hypot(*(points - pillar).T)
            near = ways[ways < 0.4]
            self.assertGreater(len(near), 5, f"the pillar at {pillar} is not in the map")
            self.assertLess(abs(near - RADIUS).max(), 0.09, f"the pillar at {pillar} is blurred")


if __name__ == "__main__":
    rospy.init_node("maps_while_driving")
    rostest.rosrun("gmapping", "maps_while_driving", MapsWhileDriving)

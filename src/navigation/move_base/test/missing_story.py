#!/usr/bin/env python3
"""What amcl, slam_gmapping and move_base say when nothing is there, and as one thing comes after
the other: one line that names what is missing and for how long, at most every 5 s."""

import re
import sys
import threading
import time
import unittest

import rospy
import rostest
from made_up_robot import Robot, room
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap, GetMapResponse
from rosgraph_msgs.msg import Clock, Log
from running import wait_until

from nav_nodes.messages import grid_message

AMCL, SLAM, MOVE_BASE = NODES = ("/amcl", "/slam_gmapping", "/move_base")
TICK = 0.02  # s
CLOCK = r"simulated clock /clock for \d+ s: nobody publishes it; start the simulator " \
    "in another terminal, for nav_demo with roslaunch urdf02_gazebo demo02_obstacles.launch"
ODOMETRY = r"transform from odom to base_footprint for \d+ s: nothing publishes it"
LASER = r"transform from base_footprint to base_scan for \d+ s: nothing publishes it"
LATE = r"new transform from odom to base_footprint for \d+ s: the newest is \d\.\d s old"


class Missing(unittest.TestCase):
    """In this order."""

    def setUp(self):
        self.lines = []  # (s of wall time, node, line)
        rospy.Subscriber("/rosout", Log, self.hear, queue_size=100)

    def hear(self, log):
        if log.name in NODES and log.msg.startswith("no "):
            self.lines.append((time.monotonic(), log.name, log.msg))

    def said(self, node):
        return [line for _, name, line in list(self.lines) if name == node]

    def expect(self, **wanted):
        """The next line of each node: all of these things and no other."""
        for name, things in wanted.items():
            node = f"/{name}"
            wait_until(lambda node=node: self.said(node), f"a line of {node}")
            line = self.said(node)[0]
            self.assertEqual(len(re.findall(r"\bno (?!body)", line)), len(things), line)
            for thing in things:
                self.assertRegex(line, f"no {thing}")

    def begin(self):
        del self.lines[:]

    def run_clock(self):
        clock, now = rospy.Publisher("/clock", Clock, queue_size=1), 1000.0
        while not rospy.is_shutdown():
            now += TICK
            clock.publish(rospy.Time.from_sec(now))
            time.sleep(TICK)

    def test_one_thing_after_the_other(self):
        wait_until(lambda: len(self.lines) == 3, "the third line")
        (node,) = {name for _, name, _ in self.lines}  # one for all of them
        self.expect(**{node.strip("/"): [CLOCK]})
        first, second, third = (when for when, _, _ in self.lines)
        self.assertGreater(min(second - first, third - second), 4.5)

        threading.Thread(target=self.run_clock, daemon=True).start()
        wait_until(lambda: not rospy.Time.now().is_zero(), "time")
        self.begin()
        scans = r"laser scans on /scan for \d+ s: nobody publishes there sensor_msgs/LaserScan"
        self.expect(amcl=[r"map by the service /static_map for \d+ s: start map_server", scans],
                    slam_gmapping=[scans],
                    move_base=[r"map on /map for \d+ s: start map_server", ODOMETRY])

        robot = Robot((0.7, 0.7, 0.0), "scan")
        maps = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        message = grid_message(room(), "map", rospy.Time.now())
        maps.publish(message)
        message = OccupancyGrid(message.header, message.info, message.data.tolist())
        asked = threading.Event()
        rospy.Service("static_map", GetMap, lambda _: asked.set() or GetMapResponse(message))
        wait_until(asked.is_set, "amcl's question")
        time.sleep(0.2)
        self.begin()
        self.expect(amcl=[ODOMETRY, LASER], slam_gmapping=[ODOMETRY, LASER], move_base=[ODOMETRY])

        robot.speaks = {"scan", "odom", "tf"}
        rospy.wait_for_message("amcl_pose", rospy.AnyMsg, 60)
        time.sleep(0.5)
        self.begin()
        robot.speaks = {"scan", "odom"}
        self.expect(amcl=[LATE], slam_gmapping=[LATE], move_base=[LATE])

        robot.speaks = {"scan", "odom", "tf"}
        time.sleep(1.0)
        self.begin()
        robot.speaks = {"odom", "tf"}
        silent = r"for \d+ s: its publisher is silent, is the simulation paused\?"
        self.expect(amcl=[f"laser scans on /scan {silent}"],
                    slam_gmapping=[f"laser scans on /scan {silent}"],
                    move_base=[f"LaserScan on /scan {silent}"])


if __name__ == "__main__":
    rospy.init_node("missing")
    rostest.rosrun("move_base", "missing", Missing, sys.argv)

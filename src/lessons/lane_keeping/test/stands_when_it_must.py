#!/usr/bin/env python3
"""With spoilt pictures the car stands and the node says why; a killed node's car stands, too."""

import math
import os
import signal
import sys
import threading
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image

LIMIT = 60.0  # s of wall time, for whatever is waited for: the machine may be busy
DRIVES, FAST, STANDS = 0.3, 0.9, 0.02  # m/s
WAY = 0.1  # m driven, before it counts as driving: a car that is put down drops a little
STOP_TIME = 0.7  # s, simulated: a killed node's car must stand
NOTICE = 0.5  # s, simulated: the node may take so long to mistrust a frozen picture
TOPIC = "/relayed"


def as_it_is(image, _first):
    return image


def blank(image, _first):
    image.data = bytes([90]) * len(image.data)
    return image


def frozen(image, first):
    first.header = image.header
    return first


def too_short(image, _first):
    image.data = image.data[: len(image.data) // 2]
    return image


def unknown_encoding(image, _first):
    image.encoding = "holographic"
    return image


class Stands(unittest.TestCase):
    def setUp(self):
        self.came, self.speed, self.now, self.said = threading.Condition(), 0.0, 0.0, []
        self.place = (0.0, 0.0)
        self.spoil, self.first = as_it_is, None
        self.relay = rospy.Publisher(TOPIC, Image, queue_size=1)
        rospy.Subscriber("/camera", Image, self.pass_on, queue_size=1, buff_size=2**24)
        rospy.Subscriber("/ground_truth", Odometry, self.see)
        rospy.Subscriber("/rosout", Log, self.hear)

    def pass_on(self, image):
        with self.came:
            if self.first is None:
                self.first = image
            self.relay.publish(self.spoil(image, self.first))

    def see(self, truth):
        with self.came:
            twist = truth.twist.twist
            self.speed = abs(twist.linear.x) + abs(twist.linear.y) + 0.2 * abs(twist.angular.z)
            self.place = truth.pose.pose.position.x, truth.pose.pose.position.y
            self.now = truth.header.stamp.to_sec()
            self.came.notify_all()

    def hear(self, log):
        with self.came:
            if log.name == "/lane_keeping" and log.level >= Log.WARN:
                self.said.append(log.msg)
                self.came.notify_all()

    def wait_for(self, condition, what):
        with self.came:
            self.assertTrue(self.came.wait_for(condition, LIMIT),
                            f"{what}: {self.speed:.2f} m/s, said {self.said[-3:]}")

    def drive(self, speed=DRIVES):
        with self.came:
            self.spoil, self.first, begun = as_it_is, None, self.place
        self.wait_for(lambda: self.speed > speed and math.dist(self.place, begun) > WAY,
                      "does not drive")

    def stands_within(self, seconds, what):
        """From now on, in simulated time."""
        with self.came:
            begun = self.now
        self.wait_for(lambda: self.speed < STANDS, f"{what}: does not stand")
        self.assertLess(self.now - begun, seconds, what)

    def test_it_stands_and_says_so(self):
        for spoil, word in ((blank, "blank"), (frozen, "frozen"), (too_short, TOPIC),
                            (unknown_encoding, "holographic")):
            self.drive()
            with self.came:
                self.said.clear()
                self.first, self.spoil = None, spoil
            self.stands_within(NOTICE + STOP_TIME, spoil.__name__)
            self.wait_for(lambda word=word: any(word in line and TOPIC in line
                                                for line in self.said), word)
        self.drive(FAST)
        self.kill_the_node()
        self.stands_within(STOP_TIME, "killed")

    def kill_the_node(self):
        uri = rosgraph.Master("/stands_when_it_must").lookupNode("/lane_keeping")
        os.kill(xmlrpc.client.ServerProxy(uri).getPid("/stands_when_it_must")[2], signal.SIGKILL)


if __name__ == "__main__":
    rospy.init_node("stands_when_it_must")
    rostest.rosrun("lane_keeping", "stands", Stands, sys.argv)

#!/usr/bin/env python3
"""Drives between obstacles by laser alone, in the direction of the freest robot-wide strip.

只靠激光雷达避障：朝着与机器人同宽的通道最畅通的方向行驶
"""

import math
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

HALF_WIDTH = 0.27  # m: the waffle's 0.153, plus room beside it
REACH = 2.5  # m: farther points do not count
HEADINGS = np.radians(np.arange(-90, 91, 5))  # rad, left positive
SPEED, TURN = 0.22, 1.0  # m/s, rad/s, at most
TURN_GAIN = 1.5  # rad/s per rad
STOP, SLOW = 0.35, 0.5  # m: keeps STOP free ahead; slows down from STOP + SLOW on
DEAD_END = 0.5  # m: if all directions are worth less, it turns to the freest one


def free_lengths(angles, ranges):
    """Free length (m, at most REACH) of a strip in each of HEADINGS.

    angles, ranges: (N,) rad and m of a scan; inf where it saw nothing.
    """
    turned = angles - HEADINGS[:, None]  # (H, N)
    ahead, beside = ranges * np.cos(turned), ranges * np.sin(turned)
    in_strip = (ahead > 0) & (np.abs(beside) < HALF_WIDTH)
    return np.where(in_strip, ahead, REACH).min(axis=1, initial=REACH)


def command(angles, ranges):
    """Speed (m/s) and turn rate (rad/s, left positive) for a scan."""
    free = free_lengths(angles, ranges)
    worth = free * np.cos(HEADINGS)
    best = np.argmax(worth if worth.max() >= DEAD_END else free)
    ahead = free[len(HEADINGS) // 2]
    speed = SPEED * np.clip((ahead - STOP) / SLOW, 0, 1)
    return speed, np.clip(TURN_GAIN * HEADINGS[best], -TURN, TURN)


class AvoidObstacles:
    def __init__(self):
        self.publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.subscriber = rospy.Subscriber("scan", LaserScan, self.take_scan, queue_size=1)

    def take_scan(self, msg):
        ranges = np.array(msg.ranges)
        ranges[~(ranges >= msg.range_min)] = math.inf  # 0 and nan: nothing seen
        angles = msg.angle_min + msg.angle_increment * np.arange(len(ranges))
        seen = np.isfinite(ranges)
        twist = Twist()
        twist.linear.x, twist.angular.z = command(angles[seen], ranges[seen])
        self.publisher.publish(twist)

    def stop(self):
        self.subscriber.unregister()  # else the next scan would start the robot again
        self.publisher.publish(Twist())
        time.sleep(0.2)  # s, wall: sending takes time


def main():
    rospy.init_node("avoid_obstacles")
    rospy.on_shutdown(AvoidObstacles().stop)
    rospy.spin()


if __name__ == "__main__":
    main()

"""Drives a robot about by its laser alone: straight on, and off to the freer side."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

SPEED, TURN_RATE = 0.22, 0.8  # m/s, rad/s
WEAVE = 0.15  # rad/s, of the random turns on the way
AHEAD, BESIDE = np.radians((25.0, 75.0))  # to either side
NEAR_AHEAD, NEAR_BESIDE = 0.55, 0.28  # m from the laser: turn
CLEAR_AHEAD = 0.8  # m, from which on it goes on


class Steering:
    """What to do about a scan. It needs no map and no pose, which a lost robot has not."""

    def __init__(self, seed: int):
        self._random = np.random.default_rng([seed, 2])
        self._turning = 0.0  # rad/s; 0: straight on

    def choose(self, ranges: np.ndarray, bearings: np.ndarray, may_go_on: bool = True
               ) -> tuple[float, float]:
        """m/s and rad/s, by ranges (N,), m, at bearings (N,), rad, -pi to pi, left is positive."""
        ahead = ranges[np.abs(bearings) < AHEAD].min()
        beside = ranges[np.abs(bearings) < BESIDE].min()
        wanted = CLEAR_AHEAD if self._turning else NEAR_AHEAD
        if not may_go_on or beside < NEAR_BESIDE or ahead < wanted:
            if not self._turning:
                left = ranges[(bearings > 0) & (bearings < 2)].mean()
                right = ranges[(bearings < 0) & (bearings > -2)].mean()
                self._turning = TURN_RATE if left > right else -TURN_RATE
            return 0.0, self._turning
        self._turning = 0.0
        return SPEED, float(self._random.normal(0.0, WEAVE))


class Wander:
    """A command for each scan, from the first one on until it is told to stop.

    `may_go_on` says whether straight ahead is still where it may go.
    """

    def __init__(self, seed: int, may_go_on: Callable[[], bool]):
        self._steering, self._may_go_on = Steering(seed), may_go_on
        self._commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self._scans = rospy.Subscriber("/scan", LaserScan, self._take, queue_size=1)

    def stop(self) -> None:
        """Stands from now on."""
        self._scans.unregister()
        self._commands.publish(Twist())

    def _take(self, message: LaserScan) -> None:
        ranges = np.array(message.ranges)
        ranges[~(ranges >= message.range_min)] = message.range_max
        bearings = message.angle_min + message.angle_increment * np.arange(len(ranges))
        command = Twist()
        command.linear.x, command.angular.z = self._steering.choose(
            np.minimum(ranges, message.range_max), (bearings + np.pi) % (2 * np.pi) - np.pi,
            self._may_go_on())
        self._commands.publish(command)

"""Drives a robot about by its laser alone: straight on, and off to the freer side."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator

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


@contextlib.contextmanager
def wandering(seed: int, may_go_on: Callable[[], bool]) -> Iterator[None]:
    """A command for each scan meanwhile; `may_go_on` says whether straight ahead it may go."""
    steering, commands = Steering(seed), rospy.Publisher("/cmd_vel", Twist, queue_size=1)

    def take(message: LaserScan) -> None:
        ranges = np.array(message.ranges)
        ranges[~(ranges >= message.range_min)] = message.range_max
        bearings = message.angle_min + message.angle_increment * np.arange(len(ranges))
        command = Twist()
        command.linear.x, command.angular.z = steering.choose(
            np.minimum(ranges, message.range_max), (bearings + np.pi) % (2 * np.pi) - np.pi,
            may_go_on())
        commands.publish(command)

    scans = rospy.Subscriber("/scan", LaserScan, take, queue_size=1)
    try:
        yield
    finally:
        scans.unregister()
        commands.publish(Twist())

"""Checks whether the robot gets nearer to its goal, rather than just turning back and forth.

For `progress_timeout`. Upstream counts every velocity as success, so with oscillation_timeout 0 a
robot that cannot quite reach its goal stays in front of it for ever.
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.local_planning.following import Following
from nav_algorithms.poses import wrap_angle

NEARER = 0.05   # m along the path
TURNED = 0.3    # rad, towards the goal's yaw
BESIDE = 0.3    # m of path left, below which turning counts
DETOUR = 0.25   # m by which the path became longer: an obstacle was seen, which is no failure


class Progress:
    """Progress to one goal. Poses (3,) and paths (N, 3) are in one fixed frame."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Begin a new goal."""
        self._following: Following | None = None
        self._way = self._turn = math.inf

    def take(self, path: np.ndarray) -> None:
        """The path that is followed from now on. Raises ValueError if it is not a valid path."""
        self._following = Following(path)

    def is_nearer(self, pose: np.ndarray) -> bool:
        """Whether the robot is nearer than when this was last true; there must be a path."""
        following = self._following
        left = following.left(pose)
        way = float(following.lengths[-1] - following.lengths[following.at]
                    + np.hypot(*(left[0, :2] - pose[:2])))
        turn = abs(wrap_angle(left[-1, 2] - pose[2])) if way < BESIDE else math.inf
        if way > self._way + DETOUR:
            self._way, self._turn = way, math.inf
            return False
        if way < self._way - NEARER or turn < self._turn - TURNED:
            self._way, self._turn = min(way, self._way), min(turn, self._turn)
            return True
        return False

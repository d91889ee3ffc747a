"""Poses of the robot's odometry and lasers, by their frames' names."""

from __future__ import annotations

from typing import Any

import numpy as np
import rospy

from nav_algorithms import poses
from nav_nodes.laser_mount import Mount, Mounts
from nav_nodes.missing_data import MissingData
from nav_nodes.transforms import NEWEST, Transforms

PATIENCE = 0.5   # s of wall time to wait for the odometry at the time of a manually set pose


class RobotFrames:
    """The frames of one robot."""

    def __init__(self, values: dict[str, Any], missing_data: MissingData) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._missing_data = missing_data
        self._transforms = Transforms(missing_data)
        self.rename(values)

    def rename(self, values: dict[str, Any]) -> None:
        """Takes the frames' names from new values."""
        self._odom, self._base = (values[name].lstrip("/")
                                  for name in ("odom_frame_id", "base_frame_id"))
        self._transforms.chain = self._odom, self._base
        self._mounts = Mounts(self._base, self._transforms, self._missing_data)

    def clear(self) -> None:
        """Forgets all transforms, after the clock was set back."""
        self._transforms.buffer.clear()

    def odometry(self, stamp: rospy.Time, patience: float) -> np.ndarray | None:
        """The robot's pose in the odometry frame at `stamp`; waits `patience` s of wall time."""
        return self._transforms.pose(self._odom, self._base, stamp, patience)

    def moved_since(self, stamp: rospy.Time) -> np.ndarray:
        """The robot's current pose in its frame at `stamp`; zeros if odometry is unknown."""
        if not self._transforms.buffer.can_transform(self._odom, self._base, NEWEST):
            return np.zeros(3)  # as upstream: before the first odometry that is no fault
        then, now = self.odometry(stamp, PATIENCE), self.odometry(NEWEST, 0.0)
        return np.zeros(3) if then is None or now is None else poses.relative(then, now)

    def mount(self, laser: str) -> Mount | None:
        """The mount of a laser, by its frame's name."""
        return self._mounts.of(laser)

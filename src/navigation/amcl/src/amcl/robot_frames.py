"""Where the robot's odometry and its lasers are, by their frames' names."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import rospy

from nav_algorithms import poses
from nav_nodes.complaints import Complaints
from nav_nodes.mount import Mount
from nav_nodes.transforms import Transforms

POLL = 0.01      # s of wall time
PATIENCE = 0.5   # s of wall time that a pose set by hand waits for the odometry of its moment


class RobotFrames:
    """Of one robot. Waits by the wall's clock: the simulated one may stand."""

    def __init__(self, values: dict[str, Any], complaints: Complaints) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._complaints = complaints
        self._transforms = Transforms(complaints)
        self.rename(values)

    def rename(self, values: dict[str, Any]) -> None:
        """Takes the frames' names from other values."""
        self._odom, self._base = (values[name].lstrip("/")
                                  for name in ("odom_frame_id", "base_frame_id"))
        self._mounts: dict[str, Mount] = {}

    def clear(self) -> None:
        """Forgets all transforms, after the clock was set back."""
        self._transforms.buffer.clear()

    def odometry(self, stamp: rospy.Time, patience: float) -> np.ndarray | None:
        """The robot's pose in the odometry's frame then, waited for so many s of wall time."""
        end = time.monotonic() + patience
        while (not self._transforms.buffer.can_transform(self._odom, self._base, stamp)
               and time.monotonic() < end and not rospy.is_shutdown()):
            time.sleep(POLL)
        return self._transforms.pose(self._odom, self._base, stamp)

    def moved_since(self, stamp: rospy.Time) -> np.ndarray:
        """The robot's pose now in its own frame of then; at rest if the odometry cannot tell."""
        if not self._transforms.buffer.can_transform(self._odom, self._base, rospy.Time(0)):
            return np.zeros(3)  # as upstream: before the first odometry that is no fault
        then, now = self.odometry(stamp, PATIENCE), self.odometry(rospy.Time(0), 0.0)
        return np.zeros(3) if then is None or now is None else poses.relative(then, now)

    def mount(self, laser: str) -> Mount | None:
        """Of a laser by its frame's name; looked up once, because it is screwed on."""
        laser = laser.lstrip("/")
        if laser not in self._mounts:
            if self._transforms.pose(self._base, laser) is None:
                return None
            found = self._transforms.buffer.lookup_transform(self._base, laser, rospy.Time(0))
            what = f"level laser in frame {laser}"
            try:
                self._mounts[laser] = Mount.of(found.transform)
            except ValueError as error:
                self._complaints.missing(what, str(error))
                return None
            self._complaints.present(what)
        return self._mounts[laser]

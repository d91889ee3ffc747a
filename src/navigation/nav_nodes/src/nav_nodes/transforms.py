"""Poses of frames in the plane, by tf2, with one line that says what is missing."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros

from nav_nodes.complaints import Complaints
from nav_nodes.messages import yaw_of


class Transforms:
    """One tf2 buffer and listener a node; a lookup that fails complains and answers None."""

    def __init__(self, complaints: Complaints, cache_s: float = 30.0) -> None:
        self.buffer = tf2_ros.Buffer(rospy.Duration(cache_s))
        self._listener = tf2_ros.TransformListener(self.buffer)
        self._complaints = complaints

    def pose(self, parent: str, child: str, stamp: rospy.Time = rospy.Time(0),
             wait_s: float = 0.0) -> np.ndarray | None:
        """(x, y, yaw) of `child` in `parent` at `stamp` (0: the newest), waited for `wait_s`."""
        what = f"transform from {parent} to {child}"
        try:
            found = self.buffer.lookup_transform(parent, child, stamp,
                                                 rospy.Duration(wait_s)).transform
        except (tf2_ros.LookupException, tf2_ros.ConnectivityException,
                tf2_ros.ExtrapolationException, tf2_ros.InvalidArgumentException) as error:
            self._complaints.missing(what, " ".join(str(error).split()))
            return None
        self._complaints.present(what)
        return np.array([found.translation.x, found.translation.y, yaw_of(found.rotation)])

"""Where the robot is, as far as tf knows it newly enough."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros

from nav_nodes.complaints import Complaints
from nav_nodes.messages import yaw_of


def newest_pose(buffer: tf2_ros.Buffer, parent: str, child: str, tolerance_s: float,
                complaints: Complaints) -> np.ndarray | None:
    """(x, y, yaw) of `child` in `parent`; None, with a line, if there is none or it is too old."""
    what = f"transform from {parent} to {child}"
    try:
        found = buffer.lookup_transform(parent, child, rospy.Time(0))
    except (tf2_ros.LookupException, tf2_ros.ConnectivityException,
            tf2_ros.ExtrapolationException, tf2_ros.InvalidArgumentException) as error:
        complaints.missing(what, " ".join(str(error).split()))
        return None
    age = (rospy.Time.now() - found.header.stamp).to_sec()
    if found.header.stamp != rospy.Time(0) and age > tolerance_s:  # 0: all of it is static
        complaints.missing(what, f"the newest is {age:.1f} s old, transform_tolerance is "
                                 f"{tolerance_s:g} s")
        return None
    complaints.present(what)
    place = found.transform.translation
    return np.array([place.x, place.y, yaw_of(found.transform.rotation)])

"""Checks goals as they are received, and transforms them."""

from __future__ import annotations

import math

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, Quaternion

from nav_algorithms.poses import compose
from nav_nodes.messages import pose_of
from nav_nodes.transforms import Transforms

INVALID = "Aborting on goal because it was sent with an invalid quaternion"


def fault_of(q: Quaternion) -> str | None:
    """The fault in a goal's orientation, in upstream's words and by its limits; or None."""
    square = q.x**2 + q.y**2 + q.z**2 + q.w**2
    if not math.isfinite(square):
        return "Quaternion has nans or infs... discarding as a navigation goal"
    if square < 1e-6:
        return "Quaternion has length close to zero... discarding as navigation goal"
    if 2.0 * (q.x**2 + q.y**2) / square > 1e-3:
        return ("Quaternion is invalid... for navigation the z-axis of the quaternion must be "
                "close to vertical.")
    return None


def in_frame(goal: PoseStamped, frame: str, transforms: Transforms) -> np.ndarray | None:
    """The goal (3,) in `frame`, by the newest transform; None, with a logged line, if unknown."""
    own, place = goal.header.frame_id.lstrip("/"), pose_of(goal.pose)
    if not np.isfinite(place).all():
        rospy.logwarn_throttle(5.0, "A goal at x %g, y %g is nowhere", *place[:2])
        return None
    if own == frame:
        return place
    if not own:
        rospy.logwarn_throttle(5.0, "Failed to transform the goal pose into the %s frame: its "
                                    "frame_id is empty; write for example map", frame)
        return None
    if not transforms.knows(own):
        rospy.logwarn_throttle(5.0, "Failed to transform the goal pose into the %s frame: nothing "
                                    "on /tf or /tf_static knows its frame_id %s; write for "
                                    "example map", frame, own)
        return None
    origin = transforms.pose(frame, own)
    return None if origin is None else compose(origin, place)

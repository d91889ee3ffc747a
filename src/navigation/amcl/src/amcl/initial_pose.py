"""The initial pose, saved on the parameter server for the node's next start.

Upstream saves no odometry with it: a node that is killed and restarted while the robot drives is
wrong by the distance driven since the pose was saved, with a small covariance.
"""

from __future__ import annotations

import xmlrpc.client
from http.client import HTTPException
from typing import Any

import numpy as np
import rospy

from nav_algorithms import poses

SAVED = "~saved_pose"  # beside upstream's: {pose: [x, y, yaw], odometry: [x, y, yaw], stamp: s}
LATELY = 60.0          # s of ROS time; later the odometry may have been reset
UNANSWERED = (OSError, xmlrpc.client.Error, HTTPException, rospy.ROSException)
DRIFT = 0.2            # error as a share of distance and turn by odometry since then


def initial_pose(values: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """(pose (3,), covariance (3, 3)) of ~initial_pose_* and ~initial_cov_* as they are now.

    Values that are not numbers are ignored in favour of those read at start, as upstream.
    """
    def number(name: str) -> float:
        value = rospy.get_param("~" + name, values[name])
        if isinstance(value, (int, float)) and np.isfinite(value):
            return float(value)
        rospy.logwarn("%s is %r: passed over", rospy.resolve_name("~" + name), value)
        return values[name]

    pose = np.array([number(f"initial_pose_{axis}") for axis in "xya"])
    variances = [max(0.0, number(f"initial_cov_{axes}")) for axes in ("xx", "yy", "aa")]
    return pose, np.diag(variances)


def save_pose(pose: np.ndarray, covariance: np.ndarray, odometry: np.ndarray) -> None:
    """Save it for initial_pose and saved_pose; errors of the master are ignored.

    `odometry` (3,) is the robot's pose in the odometry's frame at that time.
    """
    try:
        for axis, value in zip("xya", pose, strict=True):
            rospy.set_param(f"~initial_pose_{axis}", float(value))
        for axes, value in zip(("xx", "yy", "aa"), np.diag(covariance), strict=True):
            rospy.set_param(f"~initial_cov_{axes}", float(value))
        rospy.set_param(SAVED, {"pose": pose.tolist(), "odometry": odometry.tolist(),
                                "stamp": rospy.get_time()})
    except UNANSWERED:
        rospy.logdebug("the pose could not be saved: no master")


def saved_pose(values: dict[str, Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """(pose, covariance, odometry) as recently saved; None if the initial pose was set since."""
    pose, covariance = initial_pose(values)
    try:
        saved = rospy.get_param(SAVED, {})
        if saved["pose"] == pose.tolist() and 0 <= rospy.get_time() - saved["stamp"] < LATELY:
            return pose, covariance, np.array(saved["odometry"], float).reshape(3)
    except (KeyError, TypeError, ValueError, *UNANSWERED):
        pass  # nothing was saved, or not by us
    return None


def carried_on(pose: np.ndarray, covariance: np.ndarray, before: np.ndarray, now: np.ndarray
               ) -> tuple[np.ndarray, np.ndarray]:
    """A pose and its covariance after the odometry went from `before` to `now`."""
    moved = poses.relative(before, now)
    way, turn = float(np.hypot(*moved[:2])), abs(float(moved[2]))
    spread = np.array([way, way, turn + way]) * DRIFT
    return poses.compose(pose, moved), covariance + np.diag(spread**2)

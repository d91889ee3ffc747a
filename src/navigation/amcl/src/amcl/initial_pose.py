"""The pose a robot starts at, kept on the parameter server, where the next start reads it."""

from __future__ import annotations

from typing import Any

import numpy as np
import rospy

from nav_algorithms.estimates import Estimate


def initial_pose(values: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """(pose (3,), covariance (3, 3)) of ~initial_pose_* and ~initial_cov_* as they are now.

    What is no number there is passed over, and the value from the start taken, as upstream.
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


def save_pose(estimate: Estimate) -> None:
    """To where initial_pose reads it; a master that does not answer is passed over."""
    try:
        for axis, value in zip("xya", estimate.pose, strict=True):
            rospy.set_param(f"~initial_pose_{axis}", float(value))
        for axes, value in zip(("xx", "yy", "aa"), np.diag(estimate.covariance), strict=True):
            rospy.set_param(f"~initial_cov_{axes}", float(value))
    except OSError:
        rospy.logdebug("the pose could not be saved: no master")

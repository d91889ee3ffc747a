"""Whether the pose is certain enough, for /diagnostics."""

from __future__ import annotations

from typing import Any

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue


def deviations(covariance: np.ndarray, values: dict[str, Any]) -> DiagnosticArray:
    """Standard deviations of a covariance (3, 3), with their warning levels."""
    found = np.sqrt(np.diag(covariance))
    axes = "x", "y", "yaw"
    levels = [values[f"std_warn_level_{axis}"] for axis in axes]
    status = DiagnosticStatus(name=f"{rospy.get_name().lstrip('/')}: Standard deviation",
                              hardware_id="None", message="OK")
    if (found > levels).any():
        status.level, status.message = DiagnosticStatus.WARN, "Too large"
    for axis, deviation, level in zip(axes, found, levels, strict=True):
        status.values += [KeyValue(f"std_{axis}", f"{deviation:g}"),
                          KeyValue(f"std_warn_level_{axis}", f"{level:g}")]
    message = DiagnosticArray(status=[status])
    message.header.stamp = rospy.Time.now()
    return message

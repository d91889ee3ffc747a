"""What amcl publishes: pose, particles, transform to odometry, and how certain the pose is."""

from __future__ import annotations

from typing import Any

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped

from amcl.conversions import ParticleCloud, pose_with_covariance
from nav_algorithms.estimates import Estimate
from nav_nodes.broadcasting import SoleBroadcaster
from nav_nodes.messages import transform_message


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


class Outputs:
    """Topics under upstream's names; `values` are by the names of the parameter table."""

    def __init__(self) -> None:
        self._pose = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=2,
                                     latch=True)
        self._cloud = rospy.Publisher("particlecloud", PoseArray, queue_size=2)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=2)
        self._transforms = SoleBroadcaster()
        self._newest_cloud = rospy.Time(0)
        self._latest: rospy.Time | None = None  # the stamp of the last transform

    def restart(self) -> None:
        """The clock was set back."""
        self._newest_cloud = rospy.Time(0)

    def pose(self, estimate: Estimate, values: dict[str, Any], stamp: rospy.Time) -> None:
        """Publish a new estimate."""
        message = pose_with_covariance(estimate)
        message.header.frame_id, message.header.stamp = _frame(values, "global"), stamp
        self._pose.publish(message)

    def transform(self, map_to_odom: np.ndarray, values: dict[str, Any], stamp: rospy.Time) -> None:
        """Future-dated by transform_tolerance; not twice with one stamp, as two lasers may cause.

        Every listener would warn of a repeated stamp and keep the first.
        """
        if stamp == self._latest:
            return
        self._latest = stamp
        ahead = rospy.Duration.from_sec(values["transform_tolerance"])
        self._transforms.sendTransform(transform_message(
            map_to_odom, _frame(values, "global"), _frame(values, "odom"), stamp + ahead))

    def cloud(self, particles: np.ndarray, values: dict[str, Any]) -> None:
        """Publish at most at gui_publish_rate, and only if there are subscribers."""
        now, rate = rospy.Time.now(), values["gui_publish_rate"]
        if not self._cloud.get_num_connections() or (
                rate > 0 and (now - self._newest_cloud).to_sec() < 1.0 / rate):
            return
        self._newest_cloud = now
        cloud = ParticleCloud(particles)
        cloud.header.frame_id, cloud.header.stamp = _frame(values, "global"), now
        self._cloud.publish(cloud)

    def diagnostics(self, covariance: np.ndarray, values: dict[str, Any]) -> None:
        """Publish whether the pose is certain enough."""
        self._diagnostics.publish(deviations(covariance, values))


def _frame(values: dict[str, Any], which: str) -> str:
    return values[f"{which}_frame_id"].lstrip("/")

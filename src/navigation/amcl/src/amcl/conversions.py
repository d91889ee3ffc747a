"""Converts between messages and the localisation's inputs and outputs; no topics, no clock."""

from __future__ import annotations

import struct
from io import BytesIO

import numpy as np
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from sensor_msgs.msg import LaserScan

from nav_algorithms.estimates import Estimate
from nav_algorithms.sensor_models import Scan
from nav_nodes.laser_mount import Mount
from nav_nodes.messages import is_valid, pose_message, pose_of

X, Y, YAW = 0, 1, 5  # of the six coordinates of a pose's covariance


def scan_of(message: LaserScan, mount: Mount, min_range: float, max_range: float) -> Scan:
    """As upstream: ranges below the minimum count as no return; bounds <= 0 mean the message's.

    Raises ValueError for a scan without beams or bounds.
    """
    reach = min(message.range_max, max_range) if max_range > 0.0 else message.range_max
    if not message.ranges or not 0.0 < reach < np.inf:
        raise ValueError(f"it has {len(message.ranges)} ranges up to {reach} m")
    nearest = max(message.range_min, min_range) if min_range > 0.0 else message.range_min
    ranges = np.array(message.ranges, float)
    with np.errstate(invalid="ignore"):
        ranges[ranges <= nearest] = reach
    angles = message.angle_min + message.angle_increment * np.arange(len(ranges))
    if not np.isfinite(angles).all():
        raise ValueError("angle_min or angle_increment is not a number")
    return Scan(ranges, -angles if mount.upside_down else angles, mount.pose, float(reach))


def known_pose(message: PoseWithCovarianceStamped) -> tuple[np.ndarray, np.ndarray]:
    """(pose (3,), covariance (3, 3)), yaw uncorrelated, as upstream. Raises ValueError."""
    pose = pose_of(message.pose.pose)
    six = np.array(message.pose.covariance).reshape(6, 6)
    covariance = np.zeros((3, 3))
    covariance[:2, :2] = six[:2, :2]
    covariance[2, 2] = six[YAW, YAW]
    if not (is_valid(message.pose.pose.orientation) and np.isfinite(pose).all()
            and np.isfinite(covariance).all()):
        raise ValueError("it holds nan, inf or a quaternion that is not a turn about z")
    return pose, covariance


def pose_with_covariance(estimate: Estimate) -> PoseWithCovarianceStamped:
    """The estimate as a message without a header."""
    message = PoseWithCovarianceStamped()
    message.pose.pose = pose_message(estimate.pose)
    six = np.zeros((6, 6))
    six[:2, :2] = estimate.covariance[:2, :2]
    six[YAW, YAW] = estimate.covariance[2, 2]
    message.pose.covariance = six.ravel().tolist()
    return message


class ParticleCloud(PoseArray):
    """A PoseArray of particles (N, 3) that is serialised as one block: 2000 poses in 0.1 ms."""

    __slots__ = ("particles",)

    def __init__(self, particles: np.ndarray) -> None:
        """Poses are computed only when it is sent."""
        super().__init__()
        self.particles = particles

    def serialize(self, buff: BytesIO) -> None:
        """Write header, number of poses, and seven numbers per pose."""
        self.header.serialize(buff)
        sevens = np.zeros((len(self.particles), 7), "<f8")
        sevens[:, :2] = self.particles[:, :2]
        sevens[:, 5] = np.sin(self.particles[:, 2] / 2)
        sevens[:, 6] = np.cos(self.particles[:, 2] / 2)
        buff.write(struct.pack("<I", len(sevens)))
        buff.write(sevens.tobytes())

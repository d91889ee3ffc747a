"""Poses in space as matrices (4, 4), to and from messages: truth need not lie in a plane."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, Vector3
from tf import transformations


def matrix_of(pose: Pose) -> np.ndarray:
    """(4, 4) of a pose; raises ValueError where it is not finite or the quaternion is 0."""
    at, turn = pose.position, pose.orientation
    numbers = np.array([at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w])
    if not np.isfinite(numbers).all() or np.linalg.norm(numbers[3:]) < 1e-6:
        raise ValueError(f"a pose of position {numbers[:3].tolist()} and quaternion "
                         f"{numbers[3:].tolist()} is none")
    matrix = transformations.quaternion_matrix(numbers[3:])
    matrix[:3, 3] = numbers[:3]
    return matrix


def transform_matrix(transform: Transform) -> np.ndarray:
    """(4, 4) of a transform from tf."""
    at = transform.translation
    return matrix_of(Pose(Point(at.x, at.y, at.z), transform.rotation))


def pose_of(matrix: np.ndarray) -> Pose:
    """geometry_msgs/Pose of (4, 4)."""
    return Pose(Point(*map(float, matrix[:3, 3])),
                Quaternion(*map(float, transformations.quaternion_from_matrix(matrix))))


def transform_of(matrix: np.ndarray) -> Transform:
    """geometry_msgs/Transform of (4, 4)."""
    pose = pose_of(matrix)
    return Transform(Vector3(pose.position.x, pose.position.y, pose.position.z), pose.orientation)


def offset(delta_x: float, delta_y: float, delta_yaw: float) -> np.ndarray:
    """(4, 4) that takes poses in the world to the map: first turned by -delta_yaw, then moved.

    As upstream: the move by (-delta_x, -delta_y) is along the map's own axes.
    """
    matrix = transformations.rotation_matrix(-delta_yaw, (0, 0, 1))
    matrix[:2, 3] = -delta_x, -delta_y
    return matrix


def map_to_odom(true_base: np.ndarray, odom_base: np.ndarray) -> np.ndarray:
    """(4, 4): where the odometry's frame must lie in the map for the base to lie at the truth."""
    return true_base @ np.linalg.inv(odom_base)

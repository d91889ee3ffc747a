"""Quaternions (x, y, z, w), matrices (3, 3) and roll, pitch, yaw (fixed axes x, y, z; rad)."""

import numpy as np


def matrix_of(quaternion: np.ndarray) -> np.ndarray:
    """Of a quaternion of any length; one of zeros, which messages often hold, turns nothing."""
    length = np.linalg.norm(quaternion)
    if length == 0.0:
        return np.eye(3)
    x, y, z, w = np.asarray(quaternion, dtype=float) / length
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def angles_of(matrix: np.ndarray) -> np.ndarray:
    """roll, pitch, yaw (3,)."""
    return np.array([np.arctan2(matrix[2, 1], matrix[2, 2]),
                     np.arcsin(np.clip(-matrix[2, 0], -1.0, 1.0)),
                     np.arctan2(matrix[1, 0], matrix[0, 0])])


def quaternion_of(angles: np.ndarray) -> np.ndarray:
    """(x, y, z, w) of roll, pitch, yaw."""
    sr, sp, sy = np.sin(np.asarray(angles) / 2.0)
    cr, cp, cy = np.cos(np.asarray(angles) / 2.0)
    return np.array([sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                     cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy])


def pose_matrix(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """A transform (4, 4) of a place (3,) and a matrix (3, 3)."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation, position
    return pose

"""Poses in the plane: (x, y, yaw) in m, m, rad. Arrays of shape (..., 3), float64."""

from __future__ import annotations

import numpy as np


def wrap_angle(angle: np.ndarray | float) -> np.ndarray | float:
    """The same angle within (-pi, pi], rad."""
    return -((-angle + np.pi) % (2 * np.pi) - np.pi)


def compose(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """`second`, given in the frame of `first`, in the frame that `first` is given in."""
    first, second = np.asarray(first, float), np.asarray(second, float)
    cos, sin = np.cos(first[..., 2]), np.sin(first[..., 2])
    x, y = second[..., 0], second[..., 1]
    return np.stack(np.broadcast_arrays(first[..., 0] + cos * x - sin * y,
                                        first[..., 1] + sin * x + cos * y,
                                        wrap_angle(first[..., 2] + second[..., 2])), axis=-1)


def invert(pose: np.ndarray) -> np.ndarray:
    """The origin in the frame of `pose`."""
    pose = np.asarray(pose, float)
    cos, sin = np.cos(pose[..., 2]), np.sin(pose[..., 2])
    return np.stack((-cos * pose[..., 0] - sin * pose[..., 1],
                     sin * pose[..., 0] - cos * pose[..., 1],
                     wrap_angle(-pose[..., 2])), axis=-1)


def relative(origin: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """`pose` in the frame of `origin`, both given in one frame."""
    return compose(invert(origin), pose)


def transform_points(pose: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Points (N, 2), m, given in the frame of `pose` (3,), in the frame that `pose` is given in."""
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    return points @ np.array([[cos, sin], [-sin, cos]]) + np.asarray(pose[:2])

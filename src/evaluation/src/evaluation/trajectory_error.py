"""Absolute trajectory error: how far an estimated path is from the true one.

ATE as J. Sturm et al. define it, "A benchmark for the evaluation of RGB-D SLAM systems" (2012);
the alignment is S. Umeyama's without scale, "Least-squares estimation of transformation parameters
between two point patterns" (1991).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.poses import transform_points, wrap_angle


@dataclass(frozen=True)
class TrajectoryError:
    """Distances between estimated and true positions at the same times, m."""

    ate_rmse: float    # after the best rigid alignment: the shape of the path
    rmse: float        # without alignment, in one frame: where the robot believed it was
    largest: float     # the largest distance without alignment
    yaw_rmse: float    # rad, after the alignment
    alignment: np.ndarray  # (3,) x, y, yaw: moves estimated poses to the true ones


def trajectory_error(estimated: np.ndarray, true: np.ndarray) -> TrajectoryError:
    """The error of poses (N, 3), row by row of one time; raises ValueError for other shapes."""
    estimated, true = np.asarray(estimated, float), np.asarray(true, float)
    if estimated.shape != true.shape or estimated.ndim != 2 or estimated.shape[1] != 3 \
            or not len(true):
        raise ValueError(f"poses are (N, 3) twice, not {estimated.shape} and {true.shape}")
    alignment = align(estimated[:, :2], true[:, :2])
    apart = np.linalg.norm(estimated[:, :2] - true[:, :2], axis=1)
    aligned = np.linalg.norm(transform_points(alignment, estimated[:, :2]) - true[:, :2], axis=1)
    turned = wrap_angle(estimated[:, 2] + alignment[2] - true[:, 2])
    return TrajectoryError(_rms(aligned), _rms(apart), float(apart.max()), _rms(turned), alignment)


def align(points: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """The pose (3,) that moves `points` (N, 2) to `targets` (N, 2) by least squares."""
    middle, target = points.mean(axis=0), targets.mean(axis=0)
    spread = (points - middle).T @ (targets - target)
    yaw = np.arctan2(spread[0, 1] - spread[1, 0], spread[0, 0] + spread[1, 1])
    turned = transform_points(np.array([0.0, 0.0, yaw]), middle[None])[0]
    return np.array([*(target - turned), yaw])


def at_moments(stamps: np.ndarray, poses: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """Poses (M, 3) at `moments` (M,), s, interpolated from poses (N, 3) at rising `stamps` (N,), s.

    NaN before the first and after the last, where nothing is known.
    """
    moments, headings = np.asarray(moments, float), np.unwrap(poses[:, 2])
    columns = [np.interp(moments, stamps, column, np.nan, np.nan)
               for column in (poses[:, 0], poses[:, 1], headings)]
    return np.stack((*columns[:2], wrap_angle(columns[2])), axis=1)


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))

"""Pure pursuit: drive the arc from the rear axle to a point ahead on the path.

Law: curvature = 2 y / d^2, for a point y to the left at the distance d (R. C. Coulter,
Implementation of the Pure Pursuit Path Tracking Algorithm, CMU-RI-TR-92-01).
"""

from __future__ import annotations

import math

import numpy as np

from .path import Path

Pose = tuple[float, float, float]  # x, y in m and yaw in rad of the rear axle's middle


def curvature_to(x: float, y: float) -> float:
    """Curvature (1/m, left positive) of the arc to a point x ahead, y to the left; 0 at (0, 0)."""
    distance_squared = x * x + y * y
    return 2 * y / distance_squared if distance_squared else 0.0


def in_car_frame(point: np.ndarray, pose: Pose) -> tuple[float, float]:
    """A point (2,) of the path's frame as x ahead and y to the left, in m."""
    dx, dy = point[0] - pose[0], point[1] - pose[1]
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return float(c * dx + s * dy), float(c * dy - s * dx)


def pure_pursuit(path: Path, pose: Pose, look_ahead: float) -> float:
    """Curvature (1/m) to the path's point `look_ahead` m after the one nearest to the car."""
    if not look_ahead > 0:
        raise ValueError(f"look_ahead must be more than 0 m, is {look_ahead!r}")
    goal = path.point(path.nearest(pose[0], pose[1]).s + look_ahead)
    return curvature_to(*in_car_frame(goal, pose))

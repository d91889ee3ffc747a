"""carrot_planner's plan: straight to the goal, or to the last free place before it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap


@dataclass(frozen=True)
class CarrotSettings:
    """Parameters of carrot_planner/CarrotPlanner; m. A step of 0 means one cell."""

    step_size: float
    min_dist_from_robot: float


def plan(costmap: Costmap, start: np.ndarray, goal: np.ndarray, footprint: np.ndarray,
         settings: CarrotSettings) -> np.ndarray | None:
    """Path (2, 3): `start` and the free place nearest to the goal on the line to it.

    The yaw is interpolated linearly from the start's to the goal's. None if the place is nearer to
    the robot than `min_dist_from_robot`.
    """
    start, goal = np.asarray(start, float), np.asarray(goal, float)
    distance = float(np.hypot(*(goal[:2] - start[:2])))
    # No cell is farther than this from a robot in the costmap.
    farthest = min(distance, float(np.hypot(*costmap.cells.shape)) * costmap.resolution)
    steps = max(int(np.ceil(farthest / (settings.step_size or costmap.resolution))), 1)
    shares = np.linspace(farthest / distance if distance else 1.0, 0.0, steps + 1)[:, None]
    turn = (goal[2] - start[2] + np.pi) % (2 * np.pi) - np.pi
    poses = start + shares * np.array([*(goal[:2] - start[:2]), turn])
    free = footprints.costs(costmap, footprint, poses) >= 0
    if not free.any() or shares[free.argmax(), 0] * distance < settings.min_dist_from_robot:
        return None
    return np.stack((start, poses[free.argmax()]))

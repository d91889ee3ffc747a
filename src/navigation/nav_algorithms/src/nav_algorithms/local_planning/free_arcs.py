"""Arcs that a car can drive now, and its distance from obstacles."""

from __future__ import annotations

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.global_planning.motion_primitives import DRIVE, move
from nav_algorithms.poses import compose, relative, wrap_angle

BENDS = 21  # curvatures that are tried if the wanted one is not free


def arc_of(pose: np.ndarray, length: float, curvature: float, step: float) -> np.ndarray:
    """Poses (M, 3) along an arc, at most `step`, m, apart; a negative length goes backwards."""
    steps = max(int(np.ceil(abs(length) / step)), 1)
    poses = np.empty((steps + 1, 3))
    poses[0] = pose
    for n in range(1, steps + 1):
        move(poses[0], DRIVE, length * n / steps, curvature, poses[n])
    return poses


def free_arc(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray, length: float,
             wanted: float, limit: float, carrot: np.ndarray) -> tuple[float, np.ndarray] | None:
    """(curvature, poses) of the wanted arc; if that is not free, of the free one that ends nearest
    to the carrot (3,). None if there is none.

    `length`, m, negative backwards; `wanted` and `limit`, 1/m; poses in the costmap's frame.
    """
    arc = arc_of(pose, length, wanted, costmap.resolution)
    if (footprints.costs(costmap, footprint, arc) >= 0).all():
        return wanted, arc
    best, least = None, np.inf
    for curvature in np.linspace(-limit, limit, BENDS):
        arc = arc_of(pose, length, curvature, costmap.resolution)
        if (footprints.costs(costmap, footprint, arc) < 0).any():
            continue
        offset = relative(arc[-1], carrot)
        error = abs(offset[1]) + 0.3 * abs(wrap_angle(offset[2]))
        if error < least:
            best, least = (float(curvature), arc), error
    return best


def space(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray) -> float:
    """Approximate distance, m, of the footprint's corners and sides from the nearest obstacle."""
    if len(footprint) < 3:
        return np.inf
    outline = np.vstack((footprint, 0.5 * (footprint + np.roll(footprint, 1, axis=0))))
    points = compose(pose, np.column_stack((outline, np.zeros(len(outline)))))[:, :2]
    cells = costmap.cells_of(points)
    inside = cells[costmap.contains(cells)]
    if not len(inside):
        return 0.0
    return float(footprints.free_radii(costmap)[tuple(inside.T)].min() * costmap.resolution)

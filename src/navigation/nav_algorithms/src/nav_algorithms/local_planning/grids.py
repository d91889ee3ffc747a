"""The distance of each cell of a local costmap from the path, and from the next target."""

from __future__ import annotations

import numpy as np

from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.global_planning.potential import spread_everywhere

TIGHT = 20.0  # cost, in free cells, of a cell where the robot's centre should not be


def distances_to(costmap: Costmap, points: np.ndarray, passable: np.ndarray) -> np.ndarray:
    """Way from each cell to the nearest of the points (N, 2), in cells (rows, columns); inf: none.

    The way leads around obstacles; cells of `passable` (M, 2) are free whatever is in them, as in
    base_local_planner's map grid, where the path is trusted more than the costmap.
    """
    crossing = np.ones(costmap.cells.shape)
    crossing[costmap.cells >= INSCRIBED] = TIGHT
    crossing[(costmap.cells == LETHAL) | (costmap.cells == UNKNOWN)] = np.inf
    cells = costmap.cells_of(passable)
    crossing[tuple(cells[costmap.contains(cells)].T)] = 1.0
    sources, seeds = _around(costmap, points)
    passable = np.isfinite(crossing[tuple(sources.T)])
    return spread_everywhere(crossing, np.ascontiguousarray(sources[passable]), seeds[passable])


def _around(costmap: Costmap, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells (S, 2) of the points and next to them, and their distance from the point, in cells."""
    beside = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij"), axis=-1).reshape(-1, 2)
    cells = (costmap.cells_of(points).reshape(-1, 1, 2) + beside)
    away = (costmap.centres_of(cells) - np.asarray(points).reshape(-1, 1, 2)) / costmap.resolution
    inside = costmap.contains(cells)
    return cells[inside], np.hypot(away[..., 0], away[..., 1])[inside]

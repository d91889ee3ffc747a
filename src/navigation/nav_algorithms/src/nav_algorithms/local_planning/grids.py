"""How far each cell of a local costmap is from the path, and from the place to come to next."""

from __future__ import annotations

import numpy as np

from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.global_planning.potential import spread_everywhere

TIGHT = 20.0  # as many cells does one count that the centre of the robot should not be in


def distances_to(costmap: Costmap, points: np.ndarray, passable: np.ndarray) -> np.ndarray:
    """Way from each cell to the nearest of the points (N, 2), in cells (rows, columns); inf: none.

    Around obstacles; the points' own cells are `passable` (M, 2) whatever is in them, as in
    base_local_planner's map grid, where the path is believed more than the costmap.
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
    """Cells (S, 2) in and beside those of the points, and how far each is from its point, cells."""
    beside = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij"), axis=-1).reshape(-1, 2)
    cells = (costmap.cells_of(points).reshape(-1, 1, 2) + beside)
    away = (costmap.centres_of(cells) - np.asarray(points).reshape(-1, 1, 2)) / costmap.resolution
    inside = costmap.contains(cells)
    return cells[inside], np.hypot(away[..., 0], away[..., 1])[inside]

"""How well a built map agrees with the true walls: precision and recall of occupied cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.cells import OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.likelihood_field import distances
from nav_algorithms.poses import invert, transform_points


@dataclass(frozen=True)
class MapAgreement:
    """Shares, 0 to 1. Near means: in the same cell of the other grid, or in one of 8 around it."""

    occupied_near_walls: float  # share of the built map's occupied cells near a true wall
    walls_found: float          # share of the true wall cells seen that are near an occupied cell
    occupied_cells: int         # of the built map
    wall_cells: int             # of the true map, seen

    def __str__(self) -> str:
        return (f"{self.occupied_near_walls:.1%} of the map's {self.occupied_cells} occupied cells "
                f"lie within one cell of a true wall; {self.walls_found:.1%} of the "
                f"{self.wall_cells} true wall cells that were seen are on the map within one cell")


def map_agreement(built: OccupancyGrid, truth: OccupancyGrid, seen: np.ndarray | None = None,
                  built_in_truth: np.ndarray = np.zeros(3),
                  occupied_from: int = 65) -> MapAgreement:
    """Compare a built map with true_map's; a share of nothing is 0.

    `seen`, bool of the truth's shape (visible_walls), says which walls the laser could see; the
    default is walls next to known cells of the built map, which is less strict: a wall that was
    seen but left unknown on both sides does not count. `built_in_truth` (3,) is the pose of the
    built map's frame in the truth's. Cells of at least `occupied_from` percent are occupied.
    """
    occupied = built.cells >= occupied_from
    walls = truth.cells == OCCUPIED
    if seen is None:
        known = built.cells != UNKNOWN
        seen = _are_near(truth, walls, built, known, invert(built_in_truth))
    else:
        seen = walls & seen
    right = _are_near(built, occupied, truth, walls, built_in_truth)
    found = _are_near(truth, seen, built, occupied, invert(built_in_truth))
    return MapAgreement(_share(right, occupied), _share(found, seen), int(occupied.sum()),
                        int(seen.sum()))


def _are_near(grid: OccupancyGrid, which: np.ndarray, other: OccupancyGrid, wanted: np.ndarray,
              grid_in_other: np.ndarray) -> np.ndarray:
    """Which of the cells `which` of `grid` are near one of `wanted` of `other`, bool."""
    chosen = np.argwhere(which)
    cells = other.cells_of(transform_points(grid_in_other, grid.centres_of(chosen)))
    inside = other.contains(cells)
    near = np.zeros(which.shape, bool)
    hit = (distances(wanted.astype(np.uint8)) < 1.5)[tuple(cells[inside].T)]  # cells, or next to it
    near[tuple(chosen[inside][hit].T)] = True
    return near


def _share(some: np.ndarray, all_of_them: np.ndarray) -> float:
    return float(some.sum() / all_of_them.sum()) if all_of_them.any() else 0.0

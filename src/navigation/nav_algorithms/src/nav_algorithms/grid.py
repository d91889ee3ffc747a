"""Occupancy grids: the map type of all modules here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.cells import Cells

UNKNOWN, FREE, OCCUPIED = -1, 0, 100  # nav_msgs/OccupancyGrid; between them: probability, percent


@dataclass(frozen=True)
class OccupancyGrid(Cells):
    """Cells in a plane; never changed in place once made.

    `cells` is int8 (rows, columns), UNKNOWN, or FREE to OCCUPIED; row 0 has the lowest y and
    column 0 the lowest x, as in nav_msgs/OccupancyGrid. `resolution` is in m per cell, `origin` the
    (x, y), m, of the outer corner of cell (0, 0) in the map's frame, whose axes the cells follow.
    """

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float]

    def __post_init__(self) -> None:
        """Raises ValueError if cells or sizes make no valid map."""
        self.check_geometry("map", np.int8)

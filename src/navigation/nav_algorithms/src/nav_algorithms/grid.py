"""Occupancy grids: what a map is to every other module here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

UNKNOWN, FREE, OCCUPIED = -1, 0, 100  # nav_msgs/OccupancyGrid; between them: probability, percent


@dataclass(frozen=True)
class OccupancyGrid:
    """Cells of a plane; never changed in place once made.

    `cells` is int8 (rows, columns), UNKNOWN, or FREE to OCCUPIED; row 0 has the lowest y and
    column 0 the lowest x, as in nav_msgs/OccupancyGrid. `resolution` is in m a cell, `origin` the
    (x, y), m, of the outer corner of cell (0, 0) in the map's frame; maps are not turned.
    """

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float]

    def __post_init__(self) -> None:
        """Raises ValueError for cells or sizes that make no map."""
        if self.cells.ndim != 2 or self.cells.dtype != np.int8:
            raise ValueError(f"cells of a map are int8 (rows, columns), "
                             f"not {self.cells.dtype} {self.cells.shape}")
        if not (np.isfinite(self.resolution) and self.resolution > 0):
            raise ValueError(f"a map's resolution is above 0 m, not {self.resolution}")
        if not np.isfinite(self.origin).all():
            raise ValueError(f"a map's origin is two finite numbers, not {self.origin}")

    def cells_of(self, points: np.ndarray) -> np.ndarray:
        """(row, column), int64 (..., 2), of points (..., 2), m; may lie outside the map."""
        points = np.asarray(points, float)
        found = np.floor((points - self.origin) / self.resolution).astype(np.int64)
        return found[..., ::-1]

    def centres_of(self, cells: np.ndarray) -> np.ndarray:
        """Centres (..., 2), m, of cells (row, column), (..., 2)."""
        return (np.asarray(cells)[..., ::-1] + 0.5) * self.resolution + self.origin

    def contains(self, cells: np.ndarray) -> np.ndarray:
        """Which (row, column) of (..., 2) lie in the map, bool (...)."""
        cells = np.asarray(cells)
        return ((cells >= 0) & (cells < self.cells.shape)).all(axis=-1)

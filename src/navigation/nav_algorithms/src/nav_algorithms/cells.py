"""The geometry of a grid of cells, shared by maps and costmaps, and the map of all modules here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

UNKNOWN, FREE, OCCUPIED = -1, 0, 100  # nav_msgs/OccupancyGrid; between them: probability, percent


class Cells:
    """Has `cells` (rows, columns), `resolution`, m per cell, and `origin`, (x, y), m.

    The origin is the outer corner of cell (0, 0); row 0 has the lowest y and column 0 the lowest x.
    """

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float]

    def check_geometry(self, what: str, kind: type) -> None:
        """Raises ValueError if cells (of dtype `kind`) or sizes make no valid `what` ("map")."""
        if self.cells.ndim != 2 or self.cells.dtype != kind:
            raise ValueError(f"cells of a {what} are {np.dtype(kind)} (rows, columns), "
                             f"not {self.cells.dtype} {self.cells.shape}")
        if not (np.isfinite(self.resolution) and self.resolution > 0):
            raise ValueError(f"a {what}'s resolution is above 0 m, not {self.resolution}")
        if not np.isfinite(self.origin).all():
            raise ValueError(f"a {what}'s origin is two finite numbers, not {self.origin}")

    def cells_of(self, points: np.ndarray) -> np.ndarray:
        """(row, column), int64 (..., 2), of points (..., 2), m; may be outside."""
        points = np.asarray(points, float)
        with np.errstate(invalid="ignore"):  # points too far away for an integer are outside, too
            found = np.floor((points - self.origin) / self.resolution).astype(np.int64)
        return found[..., ::-1]

    def centres_of(self, cells: np.ndarray) -> np.ndarray:
        """Centres (..., 2), m, of cells (row, column), (..., 2)."""
        return (np.asarray(cells)[..., ::-1] + 0.5) * self.resolution + self.origin

    def contains(self, cells: np.ndarray) -> np.ndarray:
        """Which of the cells (row, column), (..., 2), are inside, bool (...)."""
        cells = np.asarray(cells)
        return ((cells >= 0) & (cells < self.cells.shape)).all(axis=-1)


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

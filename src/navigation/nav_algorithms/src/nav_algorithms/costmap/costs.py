"""What the numbers in a costmap mean, and the costmap that planners are given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FREE = 0          # nothing near
INSCRIBED = 253   # an obstacle is within the inscribed radius: a robot centred here touches it
LETHAL = 254      # an obstacle is in the cell
UNKNOWN = 255     # never seen


@dataclass
class Costmap:
    """Costs of a plane; a layer may write into `cells`, a planner only reads them.

    `cells` is uint8 (rows, columns), C-contiguous: FREE to LETHAL, or UNKNOWN; row 0 has the lowest
    y and column 0 the lowest x. `resolution` is in m a cell, `origin` the (x, y), m, of the outer
    corner of cell (0, 0) in the costmap's frame, which is never turned.
    """

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float]

    def __post_init__(self) -> None:
        """Raises ValueError for cells or sizes that make no costmap."""
        if self.cells.ndim != 2 or self.cells.dtype != np.uint8:
            raise ValueError(f"cells of a costmap are uint8 (rows, columns), "
                             f"not {self.cells.dtype} {self.cells.shape}")
        if not (np.isfinite(self.resolution) and self.resolution > 0):
            raise ValueError(f"a costmap's resolution is above 0 m, not {self.resolution}")
        if not np.isfinite(self.origin).all():
            raise ValueError(f"a costmap's origin is two finite numbers, not {self.origin}")
        self.cells = np.ascontiguousarray(self.cells)

    def cells_of(self, points: np.ndarray) -> np.ndarray:
        """(row, column), int64 (..., 2), of points (..., 2), m; may lie outside the costmap."""
        points = np.asarray(points, float)
        found = np.floor((points - self.origin) / self.resolution).astype(np.int64)
        return found[..., ::-1]

    def centres_of(self, cells: np.ndarray) -> np.ndarray:
        """Centres (..., 2), m, of cells (row, column), (..., 2)."""
        return (np.asarray(cells)[..., ::-1] + 0.5) * self.resolution + self.origin

    def contains(self, cells: np.ndarray) -> np.ndarray:
        """Which (row, column) of (..., 2) lie in the costmap, bool (...)."""
        cells = np.asarray(cells)
        return ((cells >= 0) & (cells < self.cells.shape)).all(axis=-1)

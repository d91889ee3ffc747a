"""The meaning of a costmap's values, and the costmap that planners get."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.cells import Cells

FREE = 0          # nothing near
INSCRIBED = 253   # an obstacle is within the inscribed radius: a robot centred here touches it
LETHAL = 254      # an obstacle is in the cell
UNKNOWN = 255     # never seen


@dataclass
class Costmap(Cells):
    """Costs in a plane; a layer may write into `cells`, a planner only reads them.

    `cells` is uint8 (rows, columns), C-contiguous: FREE to LETHAL, or UNKNOWN; row 0 has the lowest
    y and column 0 the lowest x. `resolution` is in m per cell, `origin` the (x, y), m, of the outer
    corner of cell (0, 0) in the costmap's frame, whose axes the cells follow.
    """

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float]

    def __post_init__(self) -> None:
        """Raises ValueError if cells, resolution or origin make no valid costmap."""
        self.check_geometry("costmap", np.uint8)
        self.cells = np.ascontiguousarray(self.cells)

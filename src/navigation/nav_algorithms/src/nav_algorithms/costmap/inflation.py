"""The layer that keeps the robot away from obstacles: costs that decrease with the distance."""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.costmap import footprint
from nav_algorithms.costmap.costs import FREE, INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import Bounds, Layer, Window
from nav_algorithms.likelihood_field import distances


def cost_table(resolution: float, inscribed_radius: float, inflation_radius: float,
               scaling: float) -> np.ndarray:
    """Costs, uint8, by the squared distance, in cells, from the nearest obstacle's cell.

    As costmap_2d: LETHAL in it, INSCRIBED up to the inscribed radius, m, and beyond that
    252 exp(-scaling (distance - inscribed radius)), `scaling` in 1/m. The last value is FREE, for
    all beyond the inflation radius, m, which is rounded up to whole cells.
    """
    reach = max(0, math.ceil(inflation_radius / resolution))
    away = np.sqrt(np.arange(reach ** 2 + 1)) * resolution
    falling = np.exp(np.minimum(-scaling * (away - inscribed_radius), 0.0))
    costs = np.where(away <= inscribed_radius, INSCRIBED, ((INSCRIBED - 1) * falling).astype(int))
    costs[0] = LETHAL
    return np.append(costs, FREE).astype(np.uint8)


class InflationLayer(Layer):
    """Writes the costs around every LETHAL cell that the layers below left, as in costmap_2d."""

    def __init__(self, name: str, inflation_radius: float = 0.55,
                 cost_scaling_factor: float = 10.0, inflate_unknown: bool = False) -> None:
        """Radius in m, factor in 1/m; `inflate_unknown`: any cost replaces UNKNOWN."""
        super().__init__(name)
        self._radius, self._scaling = inflation_radius, cost_scaling_factor
        self._inflate_unknown = inflate_unknown
        self._inscribed_radius = 0.0
        self._table = np.zeros(1, np.uint8)
        self._resolution = 0.0
        self._begin_anew()

    def change(self, inflation_radius: float, cost_scaling_factor: float,
               inflate_unknown: bool, enabled: bool) -> None:
        """New settings; the next update writes everything again."""
        self._radius, self._scaling = inflation_radius, cost_scaling_factor
        self._inflate_unknown, self.enabled = inflate_unknown, enabled
        self._begin_anew()

    def match(self, master: Costmap) -> None:
        """A new resolution: distances in cells change."""
        self._resolution = master.resolution
        self._begin_anew()

    def set_footprint(self, corners: np.ndarray) -> None:
        """Use the inscribed radius of this footprint."""
        self._inscribed_radius = footprint.radii(corners)[0] if len(corners) > 2 else 0.0
        self._begin_anew()

    def reset(self) -> None:
        """Write everything again."""
        self._all_is_new = True

    def update_bounds(self, pose: np.ndarray, bounds: Bounds) -> None:
        """Widen by the distance to which costs reach."""
        if self._all_is_new:
            bounds.add_all()
            self._all_is_new = False
        elif self.enabled:
            bounds.widen(self._reach() * self._resolution)

    def update_costs(self, master: Costmap, window: Window) -> None:
        """Raise costs in the window, by the obstacles in it and around it."""
        if not self.enabled or self._radius <= 0:
            return
        reach = self._reach()
        rows, columns = (slice(max(part.start - reach, 0), min(part.stop + reach, size))
                         for part, size in zip(window, master.cells.shape, strict=True))
        lethal = np.ascontiguousarray(master.cells[rows, columns] == LETHAL).view(np.uint8)
        if not lethal.any():
            return
        away = distances(lethal)[window[0].start - rows.start:window[0].stop - rows.start,
                                 window[1].start - columns.start:window[1].stop - columns.start]
        squares = np.minimum(np.rint(away ** 2), len(self._table) - 1).astype(np.int64)
        costs = self._table[squares]
        target = master.cells[window]
        unknown = target == UNKNOWN
        least = FREE + 1 if self._inflate_unknown else INSCRIBED
        np.copyto(target, costs, where=np.where(unknown, costs >= least, costs > target))

    def _reach(self) -> int:
        return max(0, math.ceil(self._radius / self._resolution))

    def _begin_anew(self) -> None:
        if self._resolution:
            self._table = cost_table(self._resolution, self._inscribed_radius, self._radius,
                                     self._scaling)
        self._all_is_new = True

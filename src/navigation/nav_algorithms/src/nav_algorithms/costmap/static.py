"""The layer of the static map."""

from __future__ import annotations

import numpy as np

from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.costmap.costs import FREE, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import MAXIMUM, Bounds, Layer, Window, combine
from nav_algorithms.poses import transform_points


def costs_of(occupancy: np.ndarray, lethal_threshold: int = 100, unknown_value: int = -1,
             trinary: bool = True, track_unknown: bool = True) -> np.ndarray:
    """Costs, uint8, of a map's values, int8, both of any shape; costmap_2d's StaticLayer.

    `unknown_value` is compared as an unsigned byte, so -1 and 255 are the same. Without `trinary`
    costs between FREE and the threshold increase with the value.
    """
    values = np.asarray(occupancy, np.int8).view(np.uint8)
    threshold = max(min(lethal_threshold, 100), 0)
    table = np.arange(256)
    if trinary or not threshold:
        costs = np.full(256, FREE)
    else:
        costs = table * LETHAL // threshold
    costs = np.where(table >= threshold, LETHAL, costs)
    costs[unknown_value % 256] = UNKNOWN if track_unknown else FREE
    return costs.astype(np.uint8)[values]


class StaticLayer(Layer):
    """Copies a map into the master; in a rolling one, by the map's pose in the master's frame.

    `set_map` needs a master of the map's size unless it rolls. `frame_in_map` (3,) is the pose of
    the master's frame in the map's; None while it is unknown: then nothing is copied.
    """

    def __init__(self, name: str, rolling: bool = False, use_maximum: bool = False) -> None:
        super().__init__(name)
        self.use_maximum = use_maximum
        self.frame_in_map: np.ndarray | None = np.zeros(3)
        self._rolling = rolling
        self._map: Costmap | None = None
        self._changed = Bounds()

    @property
    def has_map(self) -> bool:
        """Whether a map was set."""
        return self._map is not None

    def set_map(self, grid: OccupancyGrid, costs: np.ndarray) -> None:
        """Set a map, with the `costs` (rows, columns) from `costs_of`."""
        self._map = Costmap(costs, grid.resolution, grid.origin)
        self._changed.add_all()

    def change_map(self, row: int, column: int, costs: np.ndarray) -> None:
        """Set new costs (rows, columns) of a part; raises ValueError if it is not within a map."""
        if self._map is None or not (
                row >= 0 and column >= 0
                and row + costs.shape[0] <= self._map.cells.shape[0]
                and column + costs.shape[1] <= self._map.cells.shape[1]):
            raise ValueError(f"a part of {costs.shape[1]} x {costs.shape[0]} cells at column "
                             f"{column}, row {row} lies outside the map")
        self._map.cells[row:row + costs.shape[0], column:column + costs.shape[1]] = costs
        corners = np.array([[row, column], [row + costs.shape[0] - 1, column + costs.shape[1] - 1]])
        self._changed.add(self._map.centres_of(corners))

    def reset(self) -> None:
        """Copy the map again."""
        self._changed.add_all()

    def update_bounds(self, pose: np.ndarray, bounds: Bounds) -> None:
        """Add what changed in the map; in a rolling master, everything."""
        if self._map is None or not self.enabled:
            return
        if self._rolling:
            bounds.add_all()
        elif (self._changed.low <= self._changed.high).all():
            bounds.add(np.stack((self._changed.low, self._changed.high)))
        self._changed = Bounds()

    def update_costs(self, master: Costmap, window: Window) -> None:
        """Copies the costs, or takes the maximum of both with `use_maximum`.

        With it, unknown cells of the map change nothing; in a rolling master they count as the
        highest cost, as upstream.
        """
        if self._map is None or not self.enabled:
            return
        target = master.cells[window]
        if self._rolling:
            if self.frame_in_map is not None:
                self._copy_moved(master, window, target)
        elif self._map.cells.shape == master.cells.shape:
            cells = self._map.cells[window]
            if self.use_maximum:
                combine(target, cells, MAXIMUM)
            else:
                target[:] = cells

    def _copy_moved(self, master: Costmap, window: Window, target: np.ndarray) -> None:
        rows, columns = (np.arange(part.start, part.stop) for part in window)
        centres = master.centres_of(np.stack(np.meshgrid(rows, columns, indexing="ij"), axis=-1))
        cells = self._map.cells_of(transform_points(self.frame_in_map, centres))
        inside = self._map.contains(cells)
        found = self._map.cells[tuple(cells[inside].T)]
        target[inside] = np.maximum(target[inside], found) if self.use_maximum else found

"""Layers combined into one costmap; an update only rewrites what changed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nav_algorithms.costmap.costs import FREE, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import Bounds, Layer, Window


class LayeredCostmap:
    """The master costmap and its layers, lowest first.

    With `rolling` the robot stays in the middle: the origin moves by whole cells, and the layers'
    data stay in place in the world. With `track_unknown` a cell that no layer knows is UNKNOWN,
    else FREE. Not thread-safe.
    """

    def __init__(self, layers: Sequence[Layer], shape: tuple[int, int], resolution: float,
                 origin: tuple[float, float], rolling: bool = False,
                 track_unknown: bool = False) -> None:
        """`shape` in (rows, columns), `resolution` in m, `origin` as in Costmap."""
        self.layers = list(layers)
        self.rolling = rolling
        self.default = UNKNOWN if track_unknown else FREE
        self.resize(shape, resolution, origin)
        self.newest = self.master  # as of the latest update, even if it was resized since

    def resize(self, shape: tuple[int, int], resolution: float,
               origin: tuple[float, float]) -> None:
        """Make a new master, and every layer starts again; the next update writes all of it."""
        self.master = Costmap(np.full(shape, self.default, np.uint8), resolution, origin)
        self._all_is_new = True
        for layer in self.layers:
            layer.match(self.master)

    def fits(self, shape: tuple[int, int], resolution: float,
             origin: tuple[float, float]) -> bool:
        """Whether the master already has this size, resolution and origin."""
        return (self.master.cells.shape == tuple(shape) and self.master.resolution == resolution
                and tuple(self.master.origin) == tuple(origin))

    def set_footprint(self, footprint: np.ndarray) -> None:
        """The robot's padded footprint (K, 2), m, in its base frame."""
        for layer in self.layers:
            layer.set_footprint(footprint)

    def update(self, pose: np.ndarray) -> Window | None:
        """Take in new data with the robot at `pose` (3,); returns the cells written, or None."""
        moved = self.rolling and self._centre_on(pose)
        bounds = Bounds()
        if self._all_is_new or moved:
            bounds.add_all()
        for layer in self.layers:
            layer.update_bounds(pose, bounds)
        window = bounds.window(self.master)
        self._all_is_new = False
        self.newest = self.master
        if window is None:
            return None
        self.master.cells[window] = self.default
        for layer in self.layers:
            layer.update_costs(self.master, window)
        return window

    def reset(self) -> None:
        """All layers forget sensor data; the next update writes everything."""
        for layer in self.layers:
            layer.reset()
        self._all_is_new = True

    def write_all(self) -> None:
        """Let the next update write everything."""
        self._all_is_new = True

    def _centre_on(self, pose: np.ndarray) -> bool:
        """Roll until the robot is in the middle, to within a cell; returns whether it rolled."""
        master = self.master
        size = np.array(master.cells.shape[::-1]) * master.resolution
        columns, rows = np.floor((pose[:2] - size / 2 - master.origin) / master.resolution
                                 ).astype(int).tolist()
        if rows == columns == 0:
            return False
        origin = (master.origin[0] + columns * master.resolution,
                  master.origin[1] + rows * master.resolution)
        self.master = Costmap(np.full_like(master.cells, self.default), master.resolution, origin)
        for layer in self.layers:
            layer.shift(rows, columns, origin)
        return True

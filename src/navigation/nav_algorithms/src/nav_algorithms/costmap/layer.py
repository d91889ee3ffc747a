"""The interface of a layered costmap's layers, and the ways of combining them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nav_algorithms.costmap.costs import UNKNOWN, Costmap

Window = tuple[slice, slice]  # rows and columns of a costmap, both with a start and a stop

OVERWRITE, MAXIMUM = 0, 1  # costmap_2d's combination_method; any other number: not combined


@dataclass
class Bounds:
    """The smallest axis-aligned rectangle, m, around all points that were added; empty at first."""

    low: np.ndarray = field(default_factory=lambda: np.full(2, np.inf))
    high: np.ndarray = field(default_factory=lambda: np.full(2, -np.inf))

    def add(self, points: np.ndarray) -> None:
        """Include points (..., 2), m."""
        points = np.asarray(points, float).reshape(-1, 2)
        self.low = np.minimum(self.low, points.min(axis=0, initial=np.inf))
        self.high = np.maximum(self.high, points.max(axis=0, initial=-np.inf))

    def add_all(self) -> None:
        """Include everything."""
        self.low, self.high = np.full(2, -np.inf), np.full(2, np.inf)

    def widen(self, margin: float) -> None:
        """Move each side outwards by `margin`, m."""
        self.low, self.high = self.low - margin, self.high + margin

    def window(self, costmap: Costmap) -> Window | None:
        """The cells of a costmap that the rectangle touches, or None."""
        if not (self.low <= self.high).all():
            return None
        columns, rows = (_span(low, high, size) for low, high, size in zip(
            (self.low - costmap.origin) / costmap.resolution,
            (self.high - costmap.origin) / costmap.resolution, costmap.cells.shape[::-1],
            strict=True))
        if rows.start >= rows.stop or columns.start >= columns.stop:
            return None
        return rows, columns


def _span(low: float, high: float, size: int) -> slice:
    """The cells from `low` to `high`, in cells, clipped to `size` cells."""
    return slice(int(np.floor(np.clip(low, 0, size))),
                 int(np.floor(np.clip(high, -1, size - 1))) + 1)


class Layer:
    """One layer; `update_bounds` of all layers is called before `update_costs` of the first.

    A layer is not thread-safe: the owner of the layered costmap locks it.
    """

    from_sensors = False  # whether recovery behaviours may clear it

    def __init__(self, name: str) -> None:
        self.name = name
        self.enabled = True

    def match(self, master: Costmap) -> None:
        """The layered costmap got this size, resolution and origin: start again."""

    def shift(self, rows: int, columns: int, origin: tuple[float, float]) -> None:
        """The window rolled: what was in cell (rows, columns) is now in (0, 0)."""

    def set_footprint(self, footprint: np.ndarray) -> None:
        """The robot's padded footprint (K, 2), m, in its base frame."""

    def update_bounds(self, pose: np.ndarray, bounds: Bounds) -> None:
        """Take in new data with the robot at `pose` (3,); add where costs will change."""

    def update_costs(self, master: Costmap, window: Window) -> None:
        """Write into the window of the master, over what the layers below wrote."""

    def reset(self) -> None:
        """Forget sensor data."""

    def clear_area(self, low: np.ndarray, high: np.ndarray, invert: bool = False) -> None:
        """Forget everything outside (inverted: inside) the rectangle from `low` to `high`, m."""


def combine(master: np.ndarray, cells: np.ndarray, method: int) -> None:
    """Combine `cells` into the window `master` in place; UNKNOWN cells change nothing."""
    known = cells != UNKNOWN
    if method == MAXIMUM:
        known &= (master == UNKNOWN) | (master < cells)
    elif method != OVERWRITE:
        return
    np.copyto(master, cells, where=known)


def shifted(cells: np.ndarray, rows: int, columns: int, default: int) -> np.ndarray:
    """Cells moved so that (rows, columns) gets to (0, 0); `default` where there were none."""
    moved = np.full_like(cells, default)
    height, width = cells.shape
    if abs(rows) < height and abs(columns) < width:
        moved[max(-rows, 0):height - max(rows, 0), max(-columns, 0):width - max(columns, 0)] = \
            cells[max(rows, 0):height + min(rows, 0), max(columns, 0):width + min(columns, 0)]
    return moved

"""The layer of 3D sensor data: a column of voxels above each cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.costmap.layer import Bounds, shifted
from nav_algorithms.costmap.obstacles import Observation, ObstacleLayer
from nav_algorithms.costmap.tracing import clear_voxels

LEVELS = 16  # at most, one bit each


@dataclass(frozen=True)
class VoxelSettings:
    """Parameters under costmap_2d's names; m, and numbers of voxels in a column."""

    origin_z: float
    z_resolution: float
    z_voxels: int
    unknown_threshold: int  # a column with more unseen voxels is UNKNOWN
    mark_threshold: int     # a column with more marks is LETHAL


class VoxelLayer(ObstacleLayer):
    """An obstacle is only cleared by rays at its own height, as in costmap_2d's VoxelLayer."""

    def __init__(self, name: str, settings: VoxelSettings, **obstacle_settings: object) -> None:
        """`obstacle_settings` are those of ObstacleLayer."""
        super().__init__(name, **obstacle_settings)
        self.settings = settings

    def match(self, master: Costmap) -> None:
        """Start again in the master's size: no voxel has been seen."""
        super().match(master)
        self._unseen = (1 << min(self.settings.z_voxels, LEVELS)) - 1
        self._marked = np.zeros(master.cells.shape, np.uint16)
        self._unknown = np.full(master.cells.shape, self._unseen, np.uint16)

    def change_settings(self, settings: VoxelSettings) -> None:
        """Set new voxel parameters; if they move the voxels, all data are forgotten."""
        places = ("origin_z", "z_resolution", "z_voxels")
        moved = any(getattr(settings, name) != getattr(self.settings, name) for name in places)
        self.settings = settings
        if moved and self.own is not None:
            self.reset()

    def shift(self, rows: int, columns: int, origin: tuple[float, float]) -> None:
        """Voxels keep their place in the world."""
        super().shift(rows, columns, origin)
        self._marked = shifted(self._marked, rows, columns, 0)
        self._unknown = shifted(self._unknown, rows, columns, self._unseen)

    def _forget(self, forgotten: np.ndarray) -> None:
        super()._forget(forgotten)
        self._marked[forgotten] = 0
        self._unknown[forgotten] = self._unseen

    def _scaled(self, points: np.ndarray) -> np.ndarray:
        """Points (..., 3), m, in (column, row, level) cells."""
        own, settings = self.own, self.settings
        return ((points - np.array([*own.origin, settings.origin_z]))
                / np.array([own.resolution, own.resolution, settings.z_resolution]))

    def _clear(self, observation: Observation, bounds: Bounds) -> None:
        """Rays end two cells before the obstacle, as upstream: cells next to it stay."""
        start = np.asarray(observation.origin, float)
        way = observation.points - start
        lengths = np.maximum(np.sqrt((way ** 2).sum(axis=1)), 1e-9)
        share = np.minimum(lengths - 2 * self.own.resolution, observation.raytrace_range) / lengths
        ends = (start + way * share[:, None])[share > 0]
        if not len(ends):
            return
        bounds.add(start[:2])
        bounds.add(ends[:, :2])
        clear_voxels(self._marked, self._unknown, self.own.cells, self._scaled(start),
                     np.ascontiguousarray(self._scaled(ends)),
                     min(self.settings.z_voxels, LEVELS), self.settings.mark_threshold,
                     self.settings.unknown_threshold)

    def _mark(self, observation: Observation, bounds: Bounds) -> None:
        points = self._obstacles(observation)
        scaled = np.floor(self._scaled(points)).astype(np.int64)
        levels = np.maximum(scaled[:, 2], 0)  # points below the floor count as on it
        cells = scaled[:, 1::-1]
        inside = self.own.contains(cells) & (levels < min(self.settings.z_voxels, LEVELS))
        where = tuple(cells[inside].T)
        bits = np.left_shift(1, levels[inside]).astype(np.uint16)
        np.bitwise_or.at(self._marked, where, bits)
        np.bitwise_and.at(self._unknown, where, ~bits)
        marks = np.unpackbits(self._marked[where].view(np.uint8).reshape(-1, 2), axis=1).sum(axis=1)
        full = marks > self.settings.mark_threshold
        self.own.cells[tuple(part[full] for part in where)] = LETHAL
        bounds.add(points[inside, :2][full])

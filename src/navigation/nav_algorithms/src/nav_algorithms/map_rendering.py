"""The map of a path and its scans: how often beams passed through each cell, and ended in it."""

from __future__ import annotations

import numpy as np

from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.compiled import compiled
from nav_algorithms.rays import count_between

MARGIN = 2.0  # m; extra size of a grid that has to be enlarged


@compiled("void(i4[:,::1], i4[:,::1], f8[:,::1], b1[::1], f8, f8, f8, f8, f8, i8)")
def _count_scan(passes: np.ndarray, hits: np.ndarray, ends: np.ndarray, is_hit: np.ndarray,
                column: float, row: float, yaw: float, laser_x: float, laser_y: float,
                sign: int) -> None:
    """Add (sign 1) or remove (sign -1) a scan, but for beams that end outside. In cells."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    from_column = int(np.floor(column + cos * laser_x - sin * laser_y))
    from_row = int(np.floor(row + sin * laser_x + cos * laser_y))
    for k in range(len(ends)):
        to_column = int(np.floor(column + cos * ends[k, 0] - sin * ends[k, 1]))
        to_row = int(np.floor(row + sin * ends[k, 0] + cos * ends[k, 1]))
        if not (0 <= to_row < len(hits) and 0 <= to_column < hits.shape[1]):
            continue
        count_between(passes, from_row, from_column, to_row, to_column, sign)
        if is_hit[k]:
            hits[to_row, to_column] += sign


class MapRendering:
    """Counts for one path, updated with as few scans as the path's change needs."""

    def __init__(self, resolution: float, lower: tuple[float, float],
                 upper: tuple[float, float], grows: bool = True) -> None:
        """An empty map from `lower` to `upper` (x, y), m, that `grows` as needed or stays so."""
        self._resolution, self._grows = resolution, grows
        self._origin = np.array(lower, float)
        columns, rows = np.ceil((np.array(upper) - lower) / resolution - 1e-9).astype(int)
        self._passes = np.zeros((rows, columns), np.int32)
        self._hits = np.zeros((rows, columns), np.int32)
        self._poses = np.zeros((0, 3))
        self._scans = np.zeros(0, np.int64)

    def follow(self, poses: np.ndarray, numbers: np.ndarray,
               scans: list[tuple[np.ndarray, np.ndarray]], laser: np.ndarray) -> None:
        """Make this the map of scans[numbers[i]] taken at poses[i], (N, 3).

        A scan is (ends (M, 2) of its beams in the robot's frame, m, which of them hit, bool (M,));
        the laser is at `laser` (x, y) in that frame, m.
        """
        both = min(len(poses), len(self._poses))
        same = ((poses[:both] == self._poses[:both]).all(axis=1)
                & (numbers[:both] == self._scans[:both]))
        common = both if same.all() else int(np.argmin(same))
        for pose, number in zip(self._poses[common:], self._scans[common:], strict=True):
            self.count(pose, scans[number], laser, -1)
        for pose, number in zip(poses[common:], numbers[common:], strict=True):
            self.count(pose, scans[number], laser)
        self._poses, self._scans = poses, numbers

    def grid(self, threshold: float) -> OccupancyGrid:
        """OCCUPIED where more than `threshold` of the beams that reached a cell ended in it."""
        seen = self._passes + self._hits
        cells = np.where(self._hits > threshold * seen, OCCUPIED, FREE)
        return OccupancyGrid(np.where(seen > 0, cells, UNKNOWN).astype(np.int8), self._resolution,
                             (float(self._origin[0]), float(self._origin[1])))

    def count(self, pose: np.ndarray, scan: tuple[np.ndarray, np.ndarray], laser: np.ndarray,
              sign: int = 1) -> None:
        """Add a scan taken at `pose` (x, y, yaw); -1 removes it. Arguments as in `follow`."""
        ends, is_hit = scan
        if not len(ends):
            return
        if self._grows:
            reach = float(np.hypot(ends[:, 0], ends[:, 1]).max()) + 2 * self._resolution
            self._cover(pose[:2] - reach, pose[:2] + reach)
        column, row = (pose[:2] - self._origin) / self._resolution
        _count_scan(self._passes, self._hits, ends / self._resolution, is_hit, column, row,
                    pose[2], *(laser / self._resolution), sign)

    def _cover(self, lower: np.ndarray, upper: np.ndarray) -> None:
        """Enlarge the grid, by whole cells, if it does not reach from lower to upper."""
        end = self._origin + self._resolution * np.array(self._passes.shape[::-1])
        margin = MARGIN / self._resolution
        before = np.ceil((self._origin - lower) / self._resolution)
        after = np.ceil((upper - end) / self._resolution)
        before = np.where(before > 0, np.ceil(before + margin), 0).astype(int)
        after = np.where(after > 0, np.ceil(after + margin), 0).astype(int)
        if before.any() or after.any():
            margins = ((before[1], after[1]), (before[0], after[0]))
            self._passes = np.pad(self._passes, margins)
            self._hits = np.pad(self._hits, margins)
            self._origin = self._origin - before * self._resolution

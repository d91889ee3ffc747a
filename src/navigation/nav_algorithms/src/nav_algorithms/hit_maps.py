"""Maps of laser hits for many particles, which share what they agree on.

Each particle's map is a table of patches; a patch is copied only when one of several owners
writes to it. A cell stores the number of beams that ended in it and the mean of their ends, so
walls are known more precisely than to a cell.
"""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled

PATCH = 16         # cells along an edge of a patch
HITS, SUM_ROW, SUM_COLUMN, NEAR = range(4)  # the values of a cell, float32
MOST_HITS = 200.0  # hits of a cell after which its mean no longer changes
ON_WALL, BESIDE_WALL = 2.0, 1.0  # values of NEAR; 0 elsewhere
ABSENT = -1


@compiled("i8(i4[:,::1], i8, i8)")
def patch_at(table: np.ndarray, row: int, column: int) -> int:
    """The patch that contains a cell, or ABSENT."""
    patch_row, patch_column = row // PATCH, column // PATCH
    if 0 <= patch_row < table.shape[0] and 0 <= patch_column < table.shape[1]:
        return table[patch_row, patch_column]
    return ABSENT


@compiled("f4(i4[:,::1], f4[:,:,:,::1], i8, i8, i8)")
def value_at(table: np.ndarray, pool: np.ndarray, row: int, column: int, what: int) -> float:
    """A value of a cell: HITS or NEAR; 0 outside the map."""
    patch = patch_at(table, row, column)
    if patch == ABSENT:
        return np.float32(0.0)
    return pool[patch, row % PATCH, column % PATCH, what]


@compiled("i8(i4[:,::1], f4[:,:,:,::1], i4[::1], i4[::1], i8[::1], i8, i8)")
def _own_patch(table: np.ndarray, pool: np.ndarray, owners: np.ndarray, free: np.ndarray,
               free_count: np.ndarray, row: int, column: int) -> int:
    """The patch that contains a cell; made or copied if it is not this table's alone."""
    patch = patch_at(table, row, column)
    if patch != ABSENT and owners[patch] == 1:
        return patch
    free_count[0] -= 1
    made = free[free_count[0]]
    if patch == ABSENT:
        pool[made] = 0.0
    else:
        pool[made] = pool[patch]
        owners[patch] -= 1
    owners[made] = 1
    table[row // PATCH, column // PATCH] = made
    return made


@compiled("void(i4[:,::1], f4[:,:,:,::1], i4[::1], i4[::1], i8[::1], f8, f8)")
def _add_hit(table: np.ndarray, pool: np.ndarray, owners: np.ndarray, free: np.ndarray,
             free_count: np.ndarray, x: float, y: float) -> None:
    """Add a beam that ended at (x, y), in cells."""
    row, column = int(np.floor(y)), int(np.floor(x))
    if value_at(table, pool, row, column, HITS) >= MOST_HITS:
        return
    patch = _own_patch(table, pool, owners, free, free_count, row, column)
    cell = pool[patch, row % PATCH, column % PATCH]
    cell[HITS] += 1.0
    cell[SUM_ROW] += y - row
    cell[SUM_COLUMN] += x - column
    if cell[NEAR] == ON_WALL:
        return
    cell[NEAR] = ON_WALL
    for beside_row in range(row - 1, row + 2):
        for beside_column in range(column - 1, column + 2):
            if value_at(table, pool, beside_row, beside_column, NEAR) == 0.0:
                patch = _own_patch(table, pool, owners, free, free_count,
                                   beside_row, beside_column)
                pool[patch, beside_row % PATCH, beside_column % PATCH, NEAR] = BESIDE_WALL


@compiled("i8(i4[:,:,::1], f4[:,:,:,::1], i4[::1], i4[::1], i8[::1], f8[:,::1], f8[:,::1], i8,"
          "i8)")
def _add_scans(tables: np.ndarray, pool: np.ndarray, owners: np.ndarray, free: np.ndarray,
               free_count: np.ndarray, poses: np.ndarray, points: np.ndarray, first: int,
               needed: int) -> int:
    """Add the points to each table at its pose; returns the table that lacks room, or their number.

    All in cells. A table is only begun if `needed` patches are free.
    """
    for i in range(first, len(poses)):
        if free_count[0] < needed:
            return i
        cos, sin = np.cos(poses[i, 2]), np.sin(poses[i, 2])
        for k in range(len(points)):
            x, y = points[k, 0], points[k, 1]
            _add_hit(tables[i], pool, owners, free, free_count,
                     poses[i, 0] + cos * x - sin * y, poses[i, 1] + sin * x + cos * y)
    return len(poses)


class HitMaps:
    """The maps of all particles.

    `tables` int32 (particles, patch rows, patch columns) index `pool` float32 (patches, PATCH,
    PATCH, 4). Cell (0, 0) of the tables begins at `origin` (x, y), m; it moves when they grow.
    """

    def __init__(self, count: int, resolution: float, lower: tuple[float, float],
                 upper: tuple[float, float]) -> None:
        """Empty maps of `count` particles from `lower` to `upper` (x, y), m."""
        self.resolution = resolution
        self.origin = np.array(lower, float)
        columns, rows = np.ceil((np.array(upper) - lower) / (PATCH * resolution)).astype(int)
        self.tables = np.full((count, max(rows, 1), max(columns, 1)), ABSENT, np.int32)
        self.pool = np.zeros((0, PATCH, PATCH, 4), np.float32)
        self._owners = np.zeros(0, np.int32)
        self._free = np.zeros(0, np.int32)
        self._free_count = np.zeros(1, np.int64)
        self._grow_pool(1024)

    def in_cells(self, poses: np.ndarray) -> np.ndarray:
        """Poses (N, 3), m and rad, as (column, row, yaw) with fractions of cells."""
        found = np.array(poses, float, order="C")
        found[:, :2] = (found[:, :2] - self.origin) / self.resolution
        return found

    def add(self, poses: np.ndarray, points: np.ndarray) -> None:
        """Add beams that ended at `points` (N, 2), m, in the frame of each pose (count, 3)."""
        if not len(points):
            return
        reach = float(np.hypot(points[:, 0], points[:, 1]).max()) + 2 * self.resolution
        self._cover(poses[:, :2].min(axis=0) - reach, poses[:, :2].max(axis=0) + reach)
        needed = (int(2 * reach / (PATCH * self.resolution)) + 2) ** 2
        cells, ends = self.in_cells(poses), np.ascontiguousarray(points) / self.resolution
        done = 0
        while done < len(cells):
            if self._free_count[0] < needed:
                self._grow_pool(max(needed, len(self.pool)))
            done = _add_scans(self.tables, self.pool, self._owners, self._free,
                              self._free_count, cells, ends, done, needed)

    def choose(self, chosen: np.ndarray) -> None:
        """Particle i continues with the map of particle chosen[i]."""
        self.tables = np.ascontiguousarray(self.tables[chosen])
        used = self.tables[self.tables != ABSENT]
        self._owners = np.bincount(used, minlength=len(self.pool)).astype(np.int32)
        unowned = np.flatnonzero(self._owners == 0)
        self._free[:len(unowned)] = unowned
        self._free_count[0] = len(unowned)

    def _grow_pool(self, more: int) -> None:
        old = len(self.pool)
        pool = np.zeros((old + more, PATCH, PATCH, 4), np.float32)  # no memory until it is used
        pool[:old] = self.pool
        self.pool = pool
        self._owners = np.concatenate((self._owners, np.zeros(more, np.int32)))
        free = self._free[:self._free_count[0]]
        self._free = np.zeros(old + more, np.int32)
        self._free[:len(free)] = free
        self._free[len(free):len(free) + more] = np.arange(old, old + more)
        self._free_count[0] += more

    def _cover(self, lower: np.ndarray, upper: np.ndarray) -> None:
        """Enlarge the tables, by whole patches, until they reach from lower to upper, m."""
        patch = PATCH * self.resolution
        rows, columns = self.tables.shape[1:]
        before = np.maximum(0, np.ceil((self.origin - lower) / patch)).astype(int)
        after = np.maximum(0, np.ceil((upper - self.origin) / patch) - (columns, rows)).astype(int)
        if before.any() or after.any():
            margins = ((0, 0), (before[1], after[1]), (before[0], after[0]))
            self.tables = np.pad(self.tables, margins, constant_values=ABSENT)
            self.origin = self.origin - before * patch

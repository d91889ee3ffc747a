"""Draws lines and polygons into cells."""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.costs import FREE, UNKNOWN


@compiled("void(u1[:,::1], i8, i8, i8[::1], i8[::1], u1)")
def draw_lines(cells: np.ndarray, row: int, column: int, end_rows: np.ndarray,
               end_columns: np.ndarray, value: int) -> None:
    """Write `value` into the cells from (row, column) to each end, both included.

    J. E. Bresenham, "Algorithm for computer control of a digital plotter" (1965): one cell per
    step along the longer side, so that a ray along a wall does not clear the wall. Cells outside
    are skipped.
    """
    rows, columns = cells.shape
    for i in range(end_rows.size):
        up, right = end_rows[i] - row, end_columns[i] - column
        step_row, step_column = (1 if up > 0 else -1), (1 if right > 0 else -1)
        up, right = abs(up), abs(right)
        r, c = row, column
        error = max(up, right) // 2
        for _ in range(max(up, right) + 1):
            if 0 <= r < rows and 0 <= c < columns:
                cells[r, c] = value
            if right >= up:
                c += step_column
                error -= up
                if error < 0:
                    r += step_row
                    error += right
            else:
                r += step_row
                error -= right
                if error < 0:
                    c += step_column
                    error += up


@compiled("i8(u2)")
def count_bits(bits: int) -> int:
    """The number of bits set, of 16."""
    count = 0
    while bits:
        bits &= bits - 1
        count += 1
    return count


@compiled("void(u2[:,::1], u2[:,::1], u1[:,::1], f8[::1], f8[:,::1], i8, i8, i8)")
def clear_voxels(marked: np.ndarray, unknown: np.ndarray, cells: np.ndarray, start: np.ndarray,
                 ends: np.ndarray, levels: int, mark_threshold: int,
                 unknown_threshold: int) -> None:
    """Clear the bits of all voxels from `start` (3,) to the `ends` (N, 3), one voxel per step.

    Points are (column, row, level) in cells. If at most `mark_threshold` marks are left in a
    column of voxels, its cell becomes FREE, or UNKNOWN with more than `unknown_threshold` unseen.
    """
    rows, columns = cells.shape
    for i in range(len(ends)):
        way = ends[i] - start
        steps = int(np.ceil(np.abs(way).max()))
        for k in range(steps + 1):
            share = k / steps if steps else 0.0
            c = int(np.floor(start[0] + share * way[0]))
            r = int(np.floor(start[1] + share * way[1]))
            level = int(np.floor(start[2] + share * way[2]))
            if not (0 <= r < rows and 0 <= c < columns and 0 <= level < levels):
                continue
            marked[r, c] &= ~np.uint16(1 << level)
            unknown[r, c] &= ~np.uint16(1 << level)
            if count_bits(marked[r, c]) <= mark_threshold:
                unseen = count_bits(unknown[r, c])
                cells[r, c] = UNKNOWN if unseen > unknown_threshold else FREE


def fill_polygon(cells: np.ndarray, corners: np.ndarray, value: int) -> None:
    """Write `value` into each cell that a convex polygon touches.

    `corners` (K, 2) are (column, row) in cells. A concave polygon is filled, in each row of cells,
    from its leftmost to its rightmost point, in the same way as
    nav_algorithms.costmap.footprint reads the costs.
    """
    height, width = cells.shape
    u0, v0 = corners.T
    u1, v1 = np.roll(corners, -1, axis=0).T
    rows = np.arange(max(int(np.floor(v0.min())), 0), min(int(np.floor(v0.max())), height - 1) + 1)
    low = np.maximum(rows[:, None], np.minimum(v0, v1))
    high = np.minimum(rows[:, None] + 1, np.maximum(v0, v1))
    slope = (u1 - u0) / np.where(v1 == v0, np.inf, v1 - v0)
    crossings = np.stack((u0 + slope * (low - v0), u0 + slope * (high - v0)))
    meets = low <= high
    left = np.where(meets, crossings, np.inf).min(axis=(0, 2), initial=np.inf)
    right = np.where(meets, crossings, -np.inf).max(axis=(0, 2), initial=-np.inf)
    for row, first, last in zip(rows.tolist(), left, right, strict=True):
        if first <= last and last >= 0 and first < width:
            cells[row, max(int(np.floor(first)), 0):int(np.floor(min(last, width - 1))) + 1] = value

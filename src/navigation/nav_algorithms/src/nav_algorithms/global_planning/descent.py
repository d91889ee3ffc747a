"""From a potential to a path: down the gradient, or from cell to cell."""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled

STEP = 0.5  # cells, as in navfn


@compiled("void(f8[:,::1], i8, i8, f8[::1])")
def _slope(potential, row, column, found):
    """Unit vector (along columns, along rows) downhill in a cell that was reached, or 0, 0."""
    rows, columns = potential.shape
    here = potential[row, column]
    for axis in range(2):
        before = after = np.inf
        if axis == 0:
            if column > 0:
                before = potential[row, column - 1]
            if column + 1 < columns:
                after = potential[row, column + 1]
        else:
            if row > 0:
                before = potential[row - 1, column]
            if row + 1 < rows:
                after = potential[row + 1, column]
        # Only the upwind side: it always leads downhill, even next to a wall and in a valley.
        side = before if before <= after else after
        down = max(here - side, 0.0)
        found[axis] = -down if before <= after else down
    length = np.hypot(found[0], found[1])
    if length > 0.0:
        found[0] /= length
        found[1] /= length


@compiled("b1(f8[:,::1], f8, f8, f8[::1])")
def _smooth_slope(potential, column, row, found):
    """The slope interpolated between the centres of four cells; false if one was not reached."""
    rows, columns = potential.shape
    c, r = int(np.floor(column)), int(np.floor(row))
    if c < 0 or r < 0 or c + 1 >= columns or r + 1 >= rows:
        return False
    corner = np.empty(2)
    found[0] = found[1] = 0.0
    for dr in range(2):
        for dc in range(2):
            if potential[r + dr, c + dc] == np.inf:
                return False
            _slope(potential, r + dr, c + dc, corner)
            share = ((column - c if dc else c + 1 - column) * (row - r if dr else r + 1 - row))
            found[0] += share * corner[0]
            found[1] += share * corner[1]
    length = np.hypot(found[0], found[1])
    if length < 1e-3:
        return False
    found[0] /= length
    found[1] /= length
    return True


@compiled("UniTuple(i8, 2)(f8[:,::1], i8, i8)")
def _lowest_around(potential, row, column):
    """The lowest of a cell and its eight neighbours; no diagonal step past a corner not reached."""
    rows, columns = potential.shape
    best_row, best_column, best = row, column, potential[row, column]
    for dr in range(-1, 2):
        for dc in range(-1, 2):
            r, c = row + dr, column + dc
            if r < 0 or c < 0 or r >= rows or c >= columns or potential[r, c] >= best:
                continue
            corner = max(potential[row, c], potential[r, column])
            if dr != 0 and dc != 0 and corner == np.inf:
                continue
            best_row, best_column, best = r, c, potential[r, c]
    return best_row, best_column


@compiled("f8[:,::1](f8[:,::1], f8, f8, b1)")
def descend(potential, column, row, across):
    """Points (N, 2), cells (column, row) with centres at integers, from a start to the source.

    Steps of half a cell along the interpolated slope (`across`); from centre to centre where there
    is no smooth slope or `across` is false. Empty if the potential leads nowhere.
    """
    rows, columns = potential.shape
    room = 4 * rows * columns + 4
    points = np.empty((room, 2))
    slope = np.empty(2)
    count = 0
    lowest = np.inf
    stalled = 0
    while count < room - 1:
        points[count, 0], points[count, 1] = column, row
        count += 1
        r, c = int(np.floor(row + 0.5)), int(np.floor(column + 0.5))
        if r < 0 or c < 0 or r >= rows or c >= columns or potential[r, c] == np.inf:
            return np.empty((0, 2))
        if potential[r, c] == 0.0:
            points[count, 0], points[count, 1] = c, r
            return points[:count + 1].copy()
        stalled = 0 if potential[r, c] < lowest else stalled + 1
        lowest = min(lowest, potential[r, c])
        if across and stalled < 6 and _smooth_slope(potential, column, row, slope):
            column, row = column + STEP * slope[0], row + STEP * slope[1]
            continue
        next_row, next_column = _lowest_around(potential, r, c)
        if next_row == r and next_column == c:
            return np.empty((0, 2))
        row, column = float(next_row), float(next_column)
    return np.empty((0, 2))

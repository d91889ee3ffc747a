"""The distance from each cell to the nearest occupied one: exact, in time linear in the cells.

P. Felzenszwalb and D. Huttenlocher, "Distance transforms of sampled functions" (2012): along each
column the distance to the nearest occupied cell, then along each row the lower envelope of the
parabolas with the squares of those distances as their minimums.
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled


@compiled("void(u1[:,::1], f8[:,::1])")
def _squares_along_columns(occupied: np.ndarray, squares: np.ndarray) -> None:
    """Squared distance of each cell to an occupied one within its column, in cells."""
    rows, columns = occupied.shape
    for column in range(columns):
        way = math.inf
        for row in range(rows):
            way = 0.0 if occupied[row, column] else way + 1.0
            squares[row, column] = way
        way = math.inf
        for row in range(rows - 1, -1, -1):
            way = 0.0 if occupied[row, column] else way + 1.0
            squares[row, column] = min(squares[row, column], way) ** 2


@compiled("i8(f8[::1], i8[::1], f8[::1])")
def _envelope(heights: np.ndarray, feet: np.ndarray, starts: np.ndarray) -> int:
    """Lower envelope of the parabolas heights[i] + (x - i)^2; returns how many are in it.

    `feet` gets their positions, `starts` the x from which each of them is the lowest.
    """
    count = 0
    for i in range(heights.size):
        if heights[i] == math.inf:
            continue
        start = -math.inf
        while count:
            foot = feet[count - 1]
            start = ((heights[i] + i * i) - (heights[foot] + foot * foot)) / (2.0 * (i - foot))
            if start > starts[count - 1]:
                break
            count -= 1
        feet[count] = i
        starts[count] = start if count else -math.inf
        count += 1
    return count


@compiled("f8[:,::1](u1[:,::1])")
def distances(occupied: np.ndarray) -> np.ndarray:
    """Distance (rows, columns), in cells, from each cell's centre to the nearest occupied one's.

    `occupied` (rows, columns) is not 0 there; if no cell is occupied, all distances are inf.
    """
    rows, columns = occupied.shape
    found = np.empty((rows, columns))
    _squares_along_columns(occupied, found)
    feet = np.empty(columns, np.int64)
    starts = np.empty(columns)
    for row in range(rows):
        heights = found[row].copy()
        count = _envelope(heights, feet, starts)
        k = 0
        for column in range(columns):
            while k + 1 < count and starts[k + 1] < column:
                k += 1
            if count:
                found[row, column] = math.sqrt(heights[feet[k]] + (column - feet[k]) ** 2)
            else:
                found[row, column] = math.inf
    return found

"""Rays through a grid, through every cell on their way.

The traversal is that of Amanatides and Woo, "A fast voxel traversal algorithm for ray tracing"
(1987): from one crossing of a cell border to the next.
"""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled


@compiled("UniTuple(f8, 3)(f8, f8, i8)")
def _axis(position: float, direction: float, cell: int) -> tuple[float, float, float]:
    """(distance to the first border, distance between borders, step in cells) along one axis."""
    if direction > 0.0:
        return (cell + 1 - position) / direction, 1.0 / direction, 1.0
    if direction < 0.0:
        return (cell - position) / direction, -1.0 / direction, -1.0
    return math.inf, math.inf, 0.0


@compiled("f8(u1[:,::1], f8, f8, f8, f8)")
def _first_occupied(occupied: np.ndarray, x: float, y: float, angle: float,
                    reach: float) -> float:
    """Distance to the first occupied cell, all in cells; inf if none is within `reach`."""
    rows, columns = occupied.shape
    column, row = math.floor(x), math.floor(y)
    cos, sin = math.cos(angle), math.sin(angle)
    next_x, every_x, step_x = _axis(x, cos, column)
    next_y, every_y, step_y = _axis(y, sin, row)
    way = 0.0
    while way <= reach:
        if 0 <= row < rows and 0 <= column < columns:
            if occupied[row, column]:
                return way
        elif ((column < 0 and cos <= 0.0) or (column >= columns and cos >= 0.0)
              or (row < 0 and sin <= 0.0) or (row >= rows and sin >= 0.0)):
            return math.inf
        if next_x < next_y:
            way = next_x
            next_x += every_x
            column += int(step_x)
        else:
            way = next_y
            next_y += every_y
            row += int(step_y)
    return math.inf


@compiled("f8[::1](u1[:,::1], f8, f8, f8, f8, f8, f8[::1], f8)")
def cast(occupied: np.ndarray, resolution: float, origin_x: float, origin_y: float,
         x: float, y: float, angles: np.ndarray, range_max: float) -> np.ndarray:
    """Ranges (N,), m, from (x, y), m, along angles (N,), rad, all in the grid's frame.

    `occupied` (rows, columns) is not 0 where a ray ends; row 0 and column 0 begin at the origin,
    m. A range is the distance to the border of the first occupied cell: 0 from within one, inf if
    none is within `range_max`, m. Rays pass freely outside the grid.
    """
    ranges = np.empty(angles.size)
    column, row = (x - origin_x) / resolution, (y - origin_y) / resolution
    for i in range(angles.size):
        ranges[i] = resolution * _first_occupied(occupied, column, row, angles[i],
                                                 range_max / resolution)
    return ranges


@compiled("void(i4[:,::1], i8, i8, i8, i8, i8)")
def count_between(counts: np.ndarray, row: int, column: int, end_row: int, end_column: int,
                  amount: int) -> None:
    """Add `amount` to each cell on the line between two cells' centres, without the last.

    Cells outside the grid are skipped.
    """
    rows, columns = counts.shape
    right, up = abs(end_column - column), abs(end_row - row)
    step_column = 1 if end_column > column else -1
    step_row = 1 if end_row > row else -1
    balance = right - up  # above 0: the vertical border comes first
    for _ in range(right + up):
        if 0 <= row < rows and 0 <= column < columns:
            counts[row, column] += amount
        if balance > 0:
            column += step_column
            balance -= 2 * up
        else:
            row += step_row
            balance += 2 * right

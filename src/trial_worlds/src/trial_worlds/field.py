"""Obstacle fields by a cellular automaton, and where a robot of given width fits through.

D. Perille, A. Truong, X. Xiao, P. Stone, "Benchmarking Metric Ground Navigation" (2020): the BARN
benchmark. A field is bool (rows, columns), True where a cylinder stands; it is crossed along its
columns, and its first and last row are walls.
"""

from __future__ import annotations

import heapq
import math

import numpy as np

FILLED, EMPTIED = 5, 1  # least filled neighbours, of eight, that fill a cell; most that empty it
STRAIGHT_AND_DIAGONAL = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]


def grow(random: np.random.Generator, rows: int, columns: int, fill: float, smoothing: int
         ) -> np.ndarray:
    """A field: each cell filled with probability `fill`, then smoothed `smoothing` times."""
    field = random.random((rows, columns)) < fill
    field[[0, -1]] = True
    for _ in range(smoothing):
        around = neighbours(field)
        field = np.where(around >= FILLED, True, np.where(around <= EMPTIED, False, field))
    return field


def neighbours(field: np.ndarray) -> np.ndarray:
    """Number of filled neighbours (of eight) of each cell; those beyond the walls are filled."""
    framed = np.pad(np.pad(field, ((0, 0), (1, 1))), ((1, 1), (0, 0)), constant_values=True)
    rows, columns = field.shape
    return sum(framed[1 + i:1 + i + rows, 1 + j:1 + j + columns].astype(int)
               for i, j in STRAIGHT_AND_DIAGONAL)


def blocked(field: np.ndarray, reach: int) -> np.ndarray:
    """Where the robot's centre cannot be: a cylinder is within a square of `reach` cells around."""
    framed = np.pad(field, reach)
    rows, columns = field.shape
    shifts = range(2 * reach + 1)
    return np.logical_or.reduce([framed[i:i + rows, j:j + columns] for i in shifts for j in shifts])


def shortest_path(closed: np.ndarray, start: tuple[int, int], goal: tuple[int, int]
                  ) -> np.ndarray | None:
    """Cells (N, 2) of the shortest path, straight and diagonal, over those that are not closed.

    It does not pass between two closed cells that touch at a corner. None if there is no path.
    """
    ways, came, front = {start: 0.0}, {}, [(0.0, start)]
    while front:
        way, cell = heapq.heappop(front)
        if cell == goal:
            return np.array(_traced(came, goal))
        if way > ways[cell]:
            continue
        for step in STRAIGHT_AND_DIAGONAL:
            beside = (cell[0] + step[0], cell[1] + step[1])
            longer = way + math.hypot(*step)
            if _is_open(closed, cell, beside) and longer < ways.get(beside, math.inf):
                ways[beside], came[beside] = longer, cell
                heapq.heappush(front, (longer, beside))
    return None


def _is_open(closed: np.ndarray, cell: tuple[int, int], beside: tuple[int, int]) -> bool:
    inside = 0 <= beside[0] < closed.shape[0] and 0 <= beside[1] < closed.shape[1]
    return bool(inside and not closed[beside]
                and not (closed[cell[0], beside[1]] and closed[beside[0], cell[1]]))


def _traced(came: dict, cell: tuple[int, int]) -> list[tuple[int, int]]:
    cells = [cell]
    while cells[-1] in came:
        cells.append(came[cells[-1]])
    return cells[::-1]

"""Cells of a grid and their neighbours."""

from __future__ import annotations

import numpy as np


def widened(cells: np.ndarray) -> np.ndarray:
    """Bool (rows, columns) with the 8 neighbours of every cell."""
    padded = np.pad(cells, 1)
    rows, columns = cells.shape
    return np.logical_or.reduce([padded[row:row + rows, column:column + columns]
                                 for row in range(3) for column in range(3)])


def reached(closed: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Bool (rows, columns): what hangs together with `starts` (N, 2), row and column.

    From cell to cell over a common side, never into one that is `closed`, bool (rows, columns).
    """
    rows, columns = closed.shape
    found = np.zeros(closed.shape, bool)
    waiting = [tuple(cell) for cell in np.asarray(starts).tolist()]
    while waiting:
        row, column = waiting.pop()
        if 0 <= row < rows and 0 <= column < columns and not (closed[row, column]
                                                              or found[row, column]):
            found[row, column] = True
            waiting += [(row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)]
    return found

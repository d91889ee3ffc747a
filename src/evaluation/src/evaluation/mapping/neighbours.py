"""Cells of a grid and their neighbours."""

from __future__ import annotations

import numpy as np
from scipy import ndimage


def widened(cells: np.ndarray) -> np.ndarray:
    """Bool (rows, columns) with the 8 neighbours of every cell."""
    return ndimage.binary_dilation(cells, np.ones((3, 3), bool))


def reached(closed: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Bool (rows, columns): what hangs together with `starts` (N, 2), row and column.

    From cell to cell over a common side, never into one that is `closed`, bool (rows, columns).
    """
    parts, _ = ndimage.label(~closed)
    inside = starts[((starts >= 0) & (starts < closed.shape)).all(axis=1)]
    numbers = parts[tuple(inside.T)]
    return np.isin(parts, numbers[numbers > 0])

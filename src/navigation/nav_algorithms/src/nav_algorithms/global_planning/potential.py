"""The cost of reaching each cell: a wavefront that spreads over a grid from its sources.

The eikonal equation |grad T| = cost, by J. Sethian's fast marching (1996): each cell's value comes
from the cheaper neighbour in x and the cheaper one in y, so that T grows evenly in all directions
and not only along the grid. navfn's "quadratic interpolation" is an approximation of this.
"""

from __future__ import annotations

import numpy as np

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.costs import INSCRIBED, UNKNOWN
from nav_algorithms.global_planning.heap import pop, push


@compiled("f8(f8[:,::1], i8, i8, f8, b1)")
def _value(found, row, column, cost, quadratic):
    """The potential of a cell with crossing cost `cost`, from its four neighbours."""
    rows, columns = found.shape
    below = found[row - 1, column] if row > 0 else np.inf
    above = found[row + 1, column] if row + 1 < rows else np.inf
    left = found[row, column - 1] if column > 0 else np.inf
    right = found[row, column + 1] if column + 1 < columns else np.inf
    first, second = min(below, above), min(left, right)
    low, high = min(first, second), max(first, second)
    if not quadratic or high - low >= cost:
        return low + cost
    return 0.5 * (low + high + np.sqrt(2.0 * cost * cost - (high - low) ** 2))


@compiled("f8[:,::1](f8[:,::1], i8[:,::1], f8[::1], i8, i8, b1, f8, f8)")
def spread(cost, sources, seeds, target_row, target_column, quadratic, heuristic, margin):
    """The potential (rows, columns): inf where the wavefront did not get to.

    `cost` is the cost of crossing each cell, above 0, inf if it cannot be crossed. `sources` are
    (row, column), (S, 2), each with a start potential from `seeds` (S,), whatever its cost. The
    wavefront stops `margin` beyond the target; if the target is outside the grid, it never stops.
    `quadratic` false: a cell's value is its cheapest neighbour's plus its cost, as on a grid.
    `heuristic` above 0 means A*: the lowest cost of a cell, for each step left to the target along
    the grid.
    """
    rows, columns = cost.shape
    found = np.full((rows, columns), np.inf)
    room = 4 * rows * columns + len(sources) + 1
    keys, items = np.empty(room), np.empty(room, np.int64)
    closed = np.zeros((rows, columns), np.uint8)
    count = 0
    for n in range(len(sources)):
        row, column = sources[n]
        if 0 <= row < rows and 0 <= column < columns and found[row, column] > seeds[n]:
            found[row, column] = seeds[n]
            count = push(keys, items, count, seeds[n], row * columns + column)
    inside = 0 <= target_row < rows and 0 <= target_column < columns
    while count > 0:
        key, item = keys[0], items[0]
        count = pop(keys, items, count)
        row, column = item // columns, item % columns
        if inside and key > found[target_row, target_column] + margin:
            break
        if closed[row, column]:
            continue
        closed[row, column] = 1
        for side in range(4):
            r = row + (1 if side == 0 else -1 if side == 1 else 0)
            c = column + (1 if side == 2 else -1 if side == 3 else 0)
            if (r < 0 or c < 0 or r >= rows or c >= columns or closed[r, c]
                    or cost[r, c] == np.inf):
                continue
            value = _value(found, r, c, cost[r, c], quadratic)
            if value < found[r, c]:
                found[r, c] = value
                if heuristic > 0.0:
                    value += heuristic * (abs(target_row - r) + abs(target_column - c))
                count = push(keys, items, count, value, r * columns + c)
    return found


def spread_everywhere(cost: np.ndarray, sources: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """As `spread`, with quadratic interpolation, to all cells that can be reached."""
    return spread(cost, sources, seeds, -1, -1, True, 0.0, 0.0)


def crossing_costs(cells: np.ndarray, neutral: float, factor: float, lethal: int, unknown: float
                   ) -> np.ndarray:
    """Cost of crossing each cell, float64: neutral + factor * cell, below `lethal`; else inf.

    `cells` are a costmap's; unknown cells cost `unknown` (inf: not crossed). The border cells are
    blocked, as in upstream's planners, so that no path touches the edge of the map.
    """
    table = np.minimum(neutral + factor * np.arange(256), float(lethal - 1))
    table[min(lethal, INSCRIBED):] = np.inf
    table[UNKNOWN] = unknown
    found = table[cells]
    found[[0, -1], :] = np.inf
    found[:, [0, -1]] = np.inf
    return found


@compiled("i8[:,::1](u1[:,::1], i8, i8)")
def way_out(cells, row, column):
    """Cells (row, column), (N, 2), from one too near to an obstacle to the nearest that is not.

    Over cells that are below LETHAL or unknown; empty if there is no way. Lets the path of a robot
    that was put next to a wall begin there.
    """
    rows, columns = cells.shape
    came = np.full(rows * columns, -1, np.int64)
    queue = np.empty(rows * columns, np.int64)
    begin, end = 0, 1
    queue[0] = row * columns + column
    came[queue[0]] = queue[0]
    while begin < end:
        item = queue[begin]
        begin += 1
        if cells[item // columns, item % columns] < INSCRIBED:
            length, at = 1, item
            while came[at] != at:
                at = came[at]
                length += 1
            found = np.empty((length, 2), np.int64)
            at = item
            for n in range(length - 1, -1, -1):
                found[n, 0], found[n, 1] = at // columns, at % columns
                at = came[at]
            return found
        for side in range(4):
            r = item // columns + (1 if side == 0 else -1 if side == 1 else 0)
            c = item % columns + (1 if side == 2 else -1 if side == 3 else 0)
            if 0 <= r < rows and 0 <= c < columns and came[r * columns + c] < 0 and (
                    cells[r, c] <= INSCRIBED or cells[r, c] == UNKNOWN):
                came[r * columns + c] = item
                queue[end] = r * columns + c
                end += 1
    return np.empty((0, 2), np.int64)

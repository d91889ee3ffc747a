"""How hard a field is to cross: the five measures of the BARN benchmark, means over a path.

The unit is the cell. As there, they are measured where the robot's centre may be (`field.blocked`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms import likelihood_field

AXES = ((0, 1), (1, 1), (1, 0), (1, -1))
EIGHT = (*AXES, *((-i, -j) for i, j in AXES))
SIXTEEN = ((0, 1), (1, 2), (1, 1), (2, 1), (1, 0), (2, -1), (1, -1), (1, -2),
           (0, -1), (-1, -2), (-1, -1), (-2, -1), (-1, 0), (-2, 1), (-1, 1), (-1, 2))
SIGHT = 3  # cells, of dispersion


@dataclass(frozen=True)
class Difficulty:
    """Harder means a larger dispersion and tortuosity, and smaller other measures."""

    closest_obstacle: float
    visibility: float  # mean view distance in eight directions
    dispersion: float  # changes between open and closed around sixteen directions
    characteristic_dimension: float  # the narrowest of four widths
    tortuosity: float  # the path's length divided by the distance between its ends


def difficulty(closed: np.ndarray, path: np.ndarray) -> Difficulty:
    """The measures of a path (N, 2), cells, given the `closed` cells, bool (rows, columns)."""
    cells = [tuple(cell) for cell in path.tolist()]
    distance = likelihood_field.distances(closed.astype(np.uint8))
    steps = np.diff(path, axis=0)
    chord = float(np.hypot(*(path[-1] - path[0])))
    return Difficulty(
        float(np.mean([distance[cell] for cell in cells])),
        float(np.mean([_visibility(closed, cell) for cell in cells])),
        float(np.mean([_dispersion(closed, cell) for cell in cells])),
        float(np.mean([min(_width(closed, cell, axis) for axis in AXES) for cell in cells])),
        float(np.hypot(*steps.T).sum() / chord) if chord else 1.0,
    )


def _ray(closed: np.ndarray, cell: tuple[int, int], step: tuple[int, int], most: int
         ) -> tuple[int, bool]:
    """Number of open cells along `step`, up to `most`, and whether a closed one follows."""
    row, column = cell
    for taken in range(most):
        row, column = row + step[0], column + step[1]
        if not (0 <= row < closed.shape[0] and 0 <= column < closed.shape[1]):
            return taken, False
        if closed[row, column]:
            return taken, True
    return most, False


def _visibility(closed: np.ndarray, cell: tuple[int, int]) -> float:
    """Mean number of open cells, including its own, on the rays that end at an obstacle."""
    rays = [_ray(closed, cell, step, sum(closed.shape)) for step in EIGHT]
    seen = [1 + steps for steps, ended in rays if ended]
    return float(np.mean(seen)) if seen else float(max(closed.shape))


def _dispersion(closed: np.ndarray, cell: tuple[int, int]) -> int:
    most = [-(-SIGHT // max(map(abs, step))) for step in SIXTEEN]
    ends = [_ray(closed, cell, step, steps)[1]
            for step, steps in zip(SIXTEEN, most, strict=True)]
    return sum(a != b for a, b in zip(ends, ends[1:] + ends[:1], strict=True))


def _width(closed: np.ndarray, cell: tuple[int, int], axis: tuple[int, int]) -> float:
    backwards = (-axis[0], -axis[1])
    steps = sum(_ray(closed, cell, way, sum(closed.shape))[0] for way in (axis, backwards))
    return float(steps * np.hypot(*axis))

"""A yard: a walled obstacle field scaled to the waffle, with room for start and goal.

The BARN benchmark's fields are 30 x 30 cells of 0.15 m for the Jackal, which is 0.430 m wide and
turns within 0.333 m. The waffle is 0.306 m wide and turns within 0.237 m about its axle: 0.71 times
both. So cells and cylinders here are 0.71 times as large, and a yard is as hard for the waffle as
that field for the Jackal: there is always a path with a free square of 5 cells around the robot.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from trial_worlds.difficulty import Difficulty, difficulty
from trial_worlds.field import blocked, grow, shortest_path

SCALE = 0.306 / 0.430
CELL = 0.15 * SCALE     # m
RADIUS = CELL / 2       # m, of a cylinder
SIZE, APRON = 30, 10    # cells: the field's sides; before and behind it
MARGIN = 5              # cells from the yard's ends to start and goal
FREE = 2                # free cells to each side of the robot's cell along the path
FILLS, SMOOTHINGS = (0.15, 0.20, 0.25, 0.30), (2, 3, 4)
KINDS = tuple(itertools.product(FILLS, SMOOTHINGS))
START_SIDE, START_TURN = 0.1, math.radians(10)  # m, rad: largest offsets of start poses


@dataclass(frozen=True)
class Yard:
    """Cells are (row, column), along y and x; the origin is mid-edge at the field's entrance."""

    seed: int
    fill: float
    smoothing: int
    cells: np.ndarray  # bool (rows, columns): where cylinders stand
    path: np.ndarray   # (N, 2), cells: the shortest path with FREE cells to each side
    difficulty: Difficulty

    @property
    def cylinders(self) -> np.ndarray:
        """Their centres (N, 2), m."""
        return places(np.argwhere(self.cells))

    @property
    def path_length(self) -> float:
        """Length of the shortest path, m."""
        return float(np.hypot(*np.diff(self.path, axis=0).T).sum()) * CELL

    @property
    def goal(self) -> tuple[float, float, float]:
        """x, y, yaw; m, rad."""
        return *places(self.path[-1:])[0].tolist(), 0.0

    def start(self, repeat: int) -> tuple[float, float, float]:
        """x, y, yaw; m, rad; in repeats other than 0 with a small random offset."""
        x, y = places(self.path[:1])[0].tolist()
        random = np.random.default_rng((self.seed, repeat))
        side, turn = random.uniform(-START_SIDE, START_SIDE), random.uniform(-1, 1) * START_TURN
        return (x, y, 0.0) if repeat == 0 else (x, y + side, turn)


def draw_yard(seed: int) -> Yard:
    """The seed's yard; fields that cannot be crossed are drawn again, as in the benchmark."""
    fill, smoothing = KINDS[seed % len(KINDS)]
    random = np.random.default_rng(seed)
    while True:
        field = grow(random, SIZE, SIZE, fill, smoothing)
        cells = _walled(field)
        closed = blocked(cells, FREE)
        path = shortest_path(closed, (SIZE // 2, MARGIN),
                             (SIZE // 2, cells.shape[1] - 1 - MARGIN))
        if path is not None:
            break
    inside = path[(path[:, 1] >= APRON) & (path[:, 1] < APRON + SIZE)] - (0, APRON)
    return Yard(seed, fill, smoothing, cells, path,
                difficulty(closed[:, APRON:APRON + SIZE], inside))


def places(cells: np.ndarray) -> np.ndarray:
    """Centres (N, 2), x and y, m, of cells (N, 2)."""
    middle = np.array([SIZE / 2, APRON])
    return ((np.asarray(cells) + 0.5 - middle) * CELL)[:, ::-1]


def _walled(field: np.ndarray) -> np.ndarray:
    """The field with an apron at either end, enclosed by a wall of cylinders."""
    cells = np.pad(field, ((0, 0), (APRON, APRON)))
    cells[[0, -1]] = True
    cells[:, [0, -1]] = True
    return cells

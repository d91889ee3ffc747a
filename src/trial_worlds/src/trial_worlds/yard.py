"""A yard: a walled obstacle field scaled to the waffle, with room for start and goal.

The BARN benchmark's fields are 30 x 30 cells of 0.15 m for the Jackal, which is 0.430 m wide and
turns within 0.333 m. The waffle is 0.306 m wide and turns within 0.237 m about its axle: 0.71 times
both. So cells and cylinders here are 0.71 times as large, and a yard is as hard for the waffle as
that field for the Jackal: there is always a path with a free square of 5 cells around the robot.
"""

from __future__ import annotations

import heapq
import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from nav_algorithms import likelihood_field

FILLED, EMPTIED = 5, 1  # least filled neighbours, of eight, that fill a cell; most that empty it
AROUND = np.array([(1, 1, 1), (1, 0, 1), (1, 1, 1)])
STRAIGHT_AND_DIAGONAL = (np.argwhere(AROUND) - 1).tolist()


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
    return ndimage.convolve(framed.astype(int), AROUND)[1:-1, 1:-1]


def blocked(field: np.ndarray, reach: int) -> np.ndarray:
    """Where the robot's centre cannot be: a cylinder is within a square of `reach` cells around."""
    return ndimage.binary_dilation(field, np.ones(2 * (2 * reach + 1,)))


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

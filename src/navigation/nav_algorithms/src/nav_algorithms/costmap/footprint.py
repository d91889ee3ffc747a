"""A robot's footprint on a costmap: sizes, padding, and its cost at a pose.

A footprint is (K, 2), m, the corners of a convex polygon in the base frame, in either order. A
concave one is filled, in each row of cells, from its leftmost to its rightmost point. Fewer than
three corners mean a round robot, as large as the costmap's inscribed radius.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numba
import numpy as np

from nav_algorithms import likelihood_field
from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap

COLLISION, ON_UNKNOWN, OUTSIDE = -1, -2, -3  # the "costs" of base_local_planner's world model
CIRCLE_CORNERS = 16
SMALLEST = 0.6  # of a footprint, to fit beside an obstacle
FIT_STEP, LEAVE_STEP = 0.02, 0.1


def circle(radius: float) -> np.ndarray:
    """The polygon that represents a round robot, (16, 2), with its corners on the circle."""
    angles = np.arange(CIRCLE_CORNERS) * 2 * np.pi / CIRCLE_CORNERS
    return radius * np.stack((np.cos(angles), np.sin(angles)), axis=1)


def padded(footprint: np.ndarray, padding: float) -> np.ndarray:
    """The footprint with each coordinate moved by `padding`, m, away from the axis next to it.

    A corner on an axis stays on it, as in costmap_2d.
    """
    footprint = np.asarray(footprint, float)
    return footprint + np.sign(footprint) * padding


def radii(footprint: np.ndarray) -> tuple[float, float]:
    """(inscribed, circumscribed) radius about the base frame's origin, m.

    Raises ValueError for fewer than three corners.
    """
    corners = np.asarray(footprint, float)
    if len(corners) < 3:
        raise ValueError(f"a footprint has three corners or more, not {len(corners)}")
    along = np.roll(corners, -1, axis=0) - corners
    lengths = np.maximum((along ** 2).sum(axis=1), 1e-12)
    share = np.clip(-(corners * along).sum(axis=1) / lengths, 0.0, 1.0)
    nearest = corners + share[:, None] * along
    return (float(np.hypot(*nearest.T).min()), float(np.hypot(*corners.T).max()))


def reach(footprint: np.ndarray) -> float:
    """The circumscribed radius about the base frame's origin, m; 0 without a footprint."""
    return float(np.hypot(*np.asarray(footprint).reshape(-1, 2).T).max(initial=0.0))


def free_radii(costmap: Costmap) -> np.ndarray:
    """Distance of each cell's centre from cells that must not be touched, in cells (rows, columns).

    Those are lethal cells, unknown cells and all outside the costmap; never inf.
    """
    shut = (costmap.cells == LETHAL) | (costmap.cells == UNKNOWN)
    rows, columns = (np.arange(size) + 0.5 for size in shut.shape)
    edge = np.minimum.outer(np.minimum(rows, rows[::-1]), np.minimum(columns, columns[::-1]))
    return np.minimum(likelihood_field.distances(shut.view(np.uint8)), edge)


class Ground(NamedTuple):
    """A costmap and a footprint for compiled code that tests many poses."""

    cells: np.ndarray       # uint8 (rows, columns)
    resolution: float       # m
    origin_x: float         # m, of the corner of cell (0, 0)
    origin_y: float
    free_radii: np.ndarray  # (rows, columns), cells: the distance from cells not to be touched
    circumscribed: float    # m: with a larger free radius the footprint need not be tested
    footprint: np.ndarray   # (K, 2), m

    @classmethod
    def of(cls, costmap: Costmap, radii: np.ndarray, footprint: np.ndarray) -> Ground:
        """`radii`: those that `free_radii` returns, maybe of a costmap without unknown cells."""
        return cls(costmap.cells, float(costmap.resolution), *map(float, costmap.origin), radii,
                   reach(footprint), footprint)


GROUND = numba.typeof(Ground(np.zeros((1, 1), np.uint8), 1.0, 0.0, 0.0, np.zeros((1, 1)), 1.0,
                             np.zeros((3, 2))))


def costs(costmap: Costmap, footprint: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """The highest cost below a footprint at poses (N, 3) in the costmap's frame, int64 (N,).

    0 to 253; COLLISION if it covers a lethal cell, else OUTSIDE if it leaves the costmap, else
    ON_UNKNOWN if it covers an unknown cell.
    """
    return costs_at(costmap.cells, costmap.resolution, *map(float, costmap.origin),
                    np.ascontiguousarray(footprint, float).reshape(-1, 2),
                    np.ascontiguousarray(np.atleast_2d(poses), float))


def shrunk_to_fit(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray) -> np.ndarray | None:
    """The footprint itself if it is free; else the largest free one, down to 0.6 of its size.

    An obstacle makes its whole cell lethal, so a robot close to one may seem to touch it. With this
    footprint it may leave, but come no closer. None: the robot is in the obstacle.
    """
    return next(shrinking(costmap, footprint, pose, FIT_STEP), None)


def shrinking(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              step: float) -> Iterator[np.ndarray]:
    """The free ones among the footprint and smaller ones, by `step` each, down to 0.6 of it."""
    for scale in np.arange(1.0, SMALLEST - 1e-9, -step):
        if costs(costmap, scale * footprint, pose)[0] >= 0:
            yield np.ascontiguousarray(scale * footprint)
        if len(footprint) < 3:
            return


def to_leave_with(costmap: Costmap, footprint: np.ndarray,
                  pose: np.ndarray) -> Iterator[np.ndarray]:
    """Footprints to try one after the other until one can move: that of `shrunk_to_fit`, and
    smaller ones if an obstacle is within a cell of the whole one.

    Where a robot stands, the obstacle layer frees the cells below it, but not those next to them:
    beside a wall it seems to fit, and to touch with whatever it does.
    """
    fitting = shrunk_to_fit(costmap, footprint, pose)
    if fitting is None:
        return
    yield fitting
    if costs(costmap, padded(footprint, costmap.resolution), pose)[0] < 0:
        for smaller in shrinking(costmap, footprint, pose, LEAVE_STEP):
            if reach(smaller) < reach(fitting) - 1e-9:
                yield smaller


@compiled("i8(u1[:,::1], f8, f8)")
def _cost_of_centre(cells, column, row):
    """For robots without a footprint: the cost of the cell with the centre, which is in cells."""
    if not (0.0 <= column < cells.shape[1] and 0.0 <= row < cells.shape[0]):
        return OUTSIDE
    cost = cells[int(row), int(column)]
    if cost == UNKNOWN:
        return ON_UNKNOWN
    return COLLISION if cost >= INSCRIBED else int(cost)


@compiled("void(f8[:,::1], i8, i8, f8, f8, f8, f8)")
def _widen(extents, bottom, top, u0, v0, u1, v1):
    """Extend the lowest and highest column of each row that an edge, in cells, passes through."""
    if v0 > v1:
        u0, v0, u1, v1 = u1, v1, u0, v0
    slope = (u1 - u0) / (v1 - v0) if v1 > v0 else 0.0
    for r in range(max(int(np.floor(v0)), bottom), min(int(np.floor(v1)), top) + 1):
        first = u0 + slope * (r - v0) if v0 < r else u0
        last = u0 + slope * (r + 1 - v0) if v1 > r + 1 else u1
        n = r - bottom
        extents[n, 0] = min(extents[n, 0], first, last)
        extents[n, 1] = max(extents[n, 1], first, last)


@compiled("i8(u1[:,::1], f8, f8, f8, f8[:,::1], f8, f8, f8)")
def cost_at(cells, resolution, origin_x, origin_y, footprint, x, y, yaw):
    """As `costs`, for one pose and for other compiled code.

    Each row of cells that the polygon meets is checked from the lowest to the highest column that
    an edge passes through: all cells that are touched, so no part of the robot is in an obstacle
    that was not checked.
    """
    column, row = (x - origin_x) / resolution, (y - origin_y) / resolution
    corners = len(footprint)
    if corners < 3:
        return _cost_of_centre(cells, column, row)
    cos, sin = np.cos(yaw) / resolution, np.sin(yaw) / resolution
    last_column, last_row = cells.shape[1] - 1, cells.shape[0] - 1
    low_column, high_column, low_row, high_row = np.inf, -np.inf, np.inf, -np.inf
    for k in range(corners):
        u = column + cos * footprint[k, 0] - sin * footprint[k, 1]
        v = row + sin * footprint[k, 0] + cos * footprint[k, 1]
        low_column, high_column = min(low_column, u), max(high_column, u)
        low_row, high_row = min(low_row, v), max(high_row, v)
    outside = (low_column < 0.0 or low_row < 0.0 or high_column >= last_column + 1
               or high_row >= last_row + 1)
    bottom, top = max(int(np.floor(low_row)), 0), min(int(np.floor(high_row)), last_row)
    if bottom > top:
        return OUTSIDE
    extents = np.empty((top - bottom + 1, 2))
    extents[:, 0], extents[:, 1] = np.inf, -np.inf
    k = corners - 1
    u0 = column + cos * footprint[k, 0] - sin * footprint[k, 1]
    v0 = row + sin * footprint[k, 0] + cos * footprint[k, 1]
    for k in range(corners):
        u = column + cos * footprint[k, 0] - sin * footprint[k, 1]
        v = row + sin * footprint[k, 0] + cos * footprint[k, 1]
        _widen(extents, bottom, top, u0, v0, u, v)
        u0, v0 = u, v
    worst, unknown = 0, False
    for r in range(bottom, top + 1):
        left = max(int(np.floor(max(extents[r - bottom, 0], -1.0))), 0)
        right = int(np.floor(min(extents[r - bottom, 1], float(last_column))))
        for c in range(left, right + 1):
            cost = cells[r, c]
            if cost == LETHAL:
                return COLLISION
            if cost == UNKNOWN:
                unknown = True
            elif cost > worst:
                worst = cost
    if outside:
        return OUTSIDE
    return ON_UNKNOWN if unknown else worst


@compiled("i8[::1](u1[:,::1], f8, f8, f8, f8[:,::1], f8[:,::1])")
def costs_at(cells, resolution, origin_x, origin_y, footprint, poses):
    """As `costs`, for other compiled code."""
    found = np.empty(len(poses), np.int64)
    for n in range(len(poses)):
        found[n] = cost_at(cells, resolution, origin_x, origin_y, footprint,
                           poses[n, 0], poses[n, 1], poses[n, 2])
    return found

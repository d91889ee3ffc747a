"""Pieces of a drive, tested on a costmap: arcs and straights, forwards and backwards, and turns.

A piece is (kind, amount, curvature): DRIVE by `amount`, m, negative backwards, with a
`curvature`, 1/m; or TURN on the spot by `amount`, rad.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numba import f8, i8

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.costs import UNKNOWN
from nav_algorithms.costmap.footprint import GROUND, ON_UNKNOWN, Ground, cost_at

DRIVE, TURN = 0, 1
TURN_STEP = 0.09  # rad between two checks; 0.33 m from the centre this is less than a cell
# Indices of `terms`, the cost factors, in metres of free road driven forwards.
COSTLY, REVERSE, CUSP, CURVING, SWERVING, TURNING = range(6)


class Vehicle(NamedTuple):
    """How a vehicle may drive, and what that costs."""

    radius: float  # m, the smallest of its turns
    reverse: bool  # it may drive backwards
    turns: bool    # it turns on the spot instead of driving curves
    allow_unknown: bool  # it may drive over unknown cells
    terms: np.ndarray    # (6,), the cost factors


VEHICLE = numba.typeof(Vehicle(1.0, True, True, True, np.zeros(6)))


@compiled("void(f8[::1], i8, f8, f8, f8[::1])")
def move(pose, kind, amount, curvature, found):
    """The end `found` of a piece that begins at `pose`."""
    x, y, yaw = pose[0], pose[1], pose[2]
    if kind == TURN:
        found[0], found[1], found[2] = x, y, yaw + amount
        return
    end = yaw + amount * curvature
    if abs(curvature) > 1e-9:
        found[0] = x + (np.sin(end) - np.sin(yaw)) / curvature
        found[1] = y + (np.cos(yaw) - np.cos(end)) / curvature
    else:
        found[0], found[1] = x + amount * np.cos(yaw), y + amount * np.sin(yaw)
    found[2] = end


@compiled("i8(i8, f8, f8)")
def steps_of(kind, amount, step):
    """The number of steps of a piece, none longer than `step`, m, or TURN_STEP."""
    return max(int(np.ceil(abs(amount) / (TURN_STEP if kind == TURN else step) - 1e-9)), 1)


@compiled(f8(GROUND, VEHICLE, f8[::1], i8, f8, f8, f8[::1]))
def cost_of(ground: Ground, vehicle: Vehicle, pose, kind, amount, curvature, found):
    """The cost of a piece from `pose`; `found` (3,) becomes its end; inf if it collides."""
    cells, resolution, terms = ground.cells, ground.resolution, vehicle.terms
    origin_x, origin_y, free_radii = ground.origin_x, ground.origin_y, ground.free_radii
    steps = steps_of(kind, amount, resolution)
    clear = ground.circumscribed / resolution + 1.5
    dear = 0.0
    for n in range(1, steps + 1):
        move(pose, kind, amount * n / steps, curvature, found)
        column, row = (found[0] - origin_x) / resolution, (found[1] - origin_y) / resolution
        if not (0.0 <= row < cells.shape[0] and 0.0 <= column < cells.shape[1]):
            return np.inf
        r, c = int(row), int(column)
        if free_radii[r, c] <= clear:
            cost = cost_at(cells, resolution, origin_x, origin_y, ground.footprint, found[0],
                           found[1], found[2])
            if cost < 0 and not (cost == ON_UNKNOWN and vehicle.allow_unknown):
                return np.inf
        dear += (0.0 if cells[r, c] == UNKNOWN else cells[r, c]) / 252.0
    length = abs(amount) * (terms[TURNING] if kind == TURN else 1.0)
    length *= 1.0 + terms[COSTLY] * dear / steps
    if kind == DRIVE:
        length *= 1.0 + terms[CURVING] * abs(curvature)
        if amount < 0.0:
            length *= terms[REVERSE]
    return length


@compiled("f8(f8[::1], i8, f8, f8, i8, f8, f8)")
def change_cost(terms, kind, amount, curvature, next_kind, next_amount, next_curvature):
    """The cost between two pieces: of a cusp, or of a change of curvature."""
    if kind == TURN or next_kind == TURN or amount == 0.0:
        return 0.0
    cost = terms[SWERVING] * abs(next_curvature - curvature)
    return cost + (terms[CUSP] if amount * next_amount < 0.0 else 0.0)

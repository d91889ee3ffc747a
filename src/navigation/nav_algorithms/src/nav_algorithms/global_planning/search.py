"""The search of hybrid A*: which pose to expand next, and which pieces to try from it."""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numba import f8

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.footprint import GROUND, Ground
from nav_algorithms.global_planning.analytic_expansion import free_way, shoot
from nav_algorithms.global_planning.heap import pop, push
from nav_algorithms.global_planning.motion_primitives import (
    DRIVE,
    TURN,
    VEHICLE,
    Vehicle,
    change_cost,
    cost_of,
)
from nav_algorithms.global_planning.reeds_shepp import PIECES

BENDS = 5           # curvatures from full lock to full lock
SPOT_TURN = 0.2618  # rad, 15 degrees
NEAR = 6.0          # turning radii within which the heuristic uses the free curve's length


class SearchLimits(NamedTuple):
    """How fine and how long a search is."""

    state_resolution: float  # m, of the cells of poses
    yaw_bins: int            # of the same, on the full circle
    length: float            # m, of one piece
    max_expansions: int
    improve_expansions: int  # after the first path was found


LIMITS = numba.typeof(SearchLimits(1.0, 1, 1.0, 1, 1))


@compiled("i8(f8, b1, b1, f8, f8[:,::1])")
def _primitives(radius, reverse, turns, length, found):
    """Fills pieces (kind, amount, curvature) (12, 3) to try from a pose; returns how many."""
    count = 0
    for n in range(BENDS):
        bend = (n - (BENDS - 1) // 2) / ((BENDS - 1) // 2) / radius
        if turns and bend != 0.0:
            continue
        for direction in range(2 if reverse else 1):
            found[count, 0], found[count, 1] = DRIVE, -length if direction else length
            found[count, 2] = bend
            count += 1
    if turns:
        for side in range(2):
            found[count, 0], found[count, 1] = TURN, -SPOT_TURN if side else SPOT_TURN
            found[count, 2] = 0.0
            count += 1
    return count


@compiled("f8[:,::1](f8[:,::1], i8[::1], i8, f8[:,::1])")
def _pieces_to(nodes, parents, node, shot):
    """The pieces (M, 3) from the start to a node, and those of the `shot` after it."""
    count, at = 0, node
    while parents[at] >= 0:
        count += 1
        at = parents[at]
    found = np.empty((count + PIECES, 3))
    at = node
    for n in range(count - 1, -1, -1):
        found[n] = nodes[at, 4:7]
        at = parents[at]
    for k in range(PIECES):
        if abs(shot[k, 1]) > 1e-6:
            found[count] = shot[k]
            count += 1
    return found[:count].copy()


@compiled("i8(f8[::1], f8, f8, f8, i8, i8, i8)")
def _state(pose, origin_x, origin_y, state_resolution, rows, columns, yaw_bins):
    """The index of the cell of (x, y, yaw) that contains a pose."""
    row = min(int((pose[1] - origin_y) / state_resolution), rows - 1)
    column = min(int((pose[0] - origin_x) / state_resolution), columns - 1)
    turn = (pose[2] / (2 * np.pi)) % 1.0
    return (row * columns + column) * yaw_bins + int(turn * yaw_bins) % yaw_bins


@compiled(f8[:, ::1](GROUND, VEHICLE, f8[:, ::1], f8[::1], f8[::1], LIMITS))
def search(ground: Ground, vehicle: Vehicle, estimate, start, goal, limits: SearchLimits):
    """Pieces (M, 3) from start to goal, see `motion_primitives`; empty if no path was found.

    `estimate` (rows, columns) is the remaining cost for a point. A node is x, y, yaw, cost, and the
    piece that led to it.
    """
    resolution, origin_x, origin_y = ground.resolution, ground.origin_x, ground.origin_y
    radius, terms = vehicle.radius, vehicle.terms
    state_resolution, yaw_bins = limits.state_resolution, limits.yaw_bins
    rows = int(np.ceil(ground.cells.shape[0] * resolution / state_resolution))
    columns = int(np.ceil(ground.cells.shape[1] * resolution / state_resolution))
    primitives = np.empty((12, 3))
    branching = _primitives(radius, vehicle.reverse, vehicle.turns, limits.length, primitives)
    room = limits.max_expansions * branching + 2
    nodes, parents = np.empty((room, 7)), np.empty(room, np.int64)
    keys, items = np.empty(room), np.empty(room, np.int64)
    best_at = np.zeros(rows * columns * yaw_bins, np.int64)  # node + 1; 0: none yet
    shot, best_shot = np.zeros((PIECES, 3)), np.zeros((PIECES, 3))
    nodes[0] = 0.0
    nodes[0, :3] = start
    parents[0] = -1
    made, count = 1, push(keys, items, 0, 0.0, 0)
    goal_cost, goal_node = np.inf, -1
    end = np.empty(3)
    expanded, until, next_shot = 0, limits.max_expansions, 0
    while count > 0 and expanded < until:
        key, node = keys[0], items[0]
        count = pop(keys, items, count)
        if key >= goal_cost:
            break
        here = nodes[node, :3].copy()
        state = _state(here, origin_x, origin_y, state_resolution, rows, columns, yaw_bins)
        if best_at[state] != node + 1 and node > 0:
            continue
        expanded += 1
        kind, amount, bend = int(nodes[node, 4]), nodes[node, 5], nodes[node, 6]
        left = key - nodes[node, 3]
        if expanded >= next_shot:
            next_shot = expanded + 1 + int(min(left / (2.0 * radius), 40.0) * 2.0)
            cost = nodes[node, 3] + shoot(ground, vehicle, here, goal, kind, amount, bend,
                                          goal_cost - nodes[node, 3], shot)
            if cost < goal_cost:
                if goal_node < 0:
                    until = min(until, expanded + limits.improve_expansions)
                goal_cost, goal_node = cost, node
                best_shot[:] = shot
        for n in range(branching):
            next_kind, size, next_bend = (int(primitives[n, 0]), primitives[n, 1],
                                          primitives[n, 2])
            cost = nodes[node, 3] + change_cost(terms, kind, amount, bend, next_kind, size,
                                                next_bend)
            cost += cost_of(ground, vehicle, here, next_kind, size, next_bend, end)
            if cost >= goal_cost or cost == np.inf:
                continue
            state = _state(end, origin_x, origin_y, state_resolution, rows, columns, yaw_bins)
            if best_at[state] > 0 and nodes[best_at[state] - 1, 3] <= cost:
                continue
            remaining = estimate[int((end[1] - origin_y) / resolution),
                                 int((end[0] - origin_x) / resolution)]
            if np.hypot(goal[0] - end[0], goal[1] - end[1]) < NEAR * radius:
                remaining = max(remaining, free_way(vehicle, end, goal))
            if cost + remaining >= goal_cost:
                continue
            nodes[made, :3] = end
            nodes[made, 3] = cost
            nodes[made, 4], nodes[made, 5], nodes[made, 6] = next_kind, size, next_bend
            parents[made] = node
            best_at[state] = made + 1
            count = push(keys, items, count, cost + remaining, made)
            made += 1
    if goal_node < 0:
        return np.empty((0, 3))
    return _pieces_to(nodes, parents, goal_node, best_shot)

"""The analytic expansion of hybrid A*: a curve that ends exactly at the goal, if it is free."""

from __future__ import annotations

import numpy as np
from numba import f8, i8

from nav_algorithms.compiled import compiled
from nav_algorithms.costmap.footprint import GROUND, Ground
from nav_algorithms.global_planning.motion_primitives import (
    CURVING,
    DRIVE,
    REVERSE,
    TURN,
    TURNING,
    VEHICLE,
    Vehicle,
    change_cost,
    cost_of,
)
from nav_algorithms.global_planning.reeds_shepp import PIECES, WORDS, dubins, reeds_shepp

TRIED = 4  # curves that are checked on the costmap, the cheapest first


@compiled("i8(f8[:,:,::1], f8[::1], f8[::1], f8, b1, b1)")
def _curves(words, pose, goal, radius, reverse, turns):
    """Fill `words` (WORDS, PIECES, 3) with ways from pose to goal; returns how many."""
    dx, dy, dyaw = goal[0] - pose[0], goal[1] - pose[1], goal[2] - pose[2]
    words[:] = 0.0
    if turns:
        count = 2 if reverse else 1
        bearing = np.arctan2(dy, dx) if dx != 0.0 or dy != 0.0 else goal[2]
        for n in range(count):
            first = (bearing - pose[2] + n * np.pi + np.pi) % (2 * np.pi) - np.pi
            last = (dyaw - first + np.pi) % (2 * np.pi) - np.pi
            words[n, 0, 0], words[n, 0, 1] = TURN, first
            words[n, 1, 0], words[n, 1, 1] = DRIVE, (-1.0 if n else 1.0) * np.hypot(dx, dy)
            words[n, 2, 0], words[n, 2, 1] = TURN, last
        return count
    found = np.empty((WORDS, PIECES, 2))
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    x, y = (cos * dx + sin * dy) / radius, (cos * dy - sin * dx) / radius
    count = reeds_shepp(found, x, y, dyaw) if reverse else dubins(found, x, y, dyaw)
    for n in range(count):
        for k in range(PIECES):
            words[n, k, 0] = DRIVE
            words[n, k, 1], words[n, k, 2] = found[n, k, 0] * radius, found[n, k, 1] / radius
    return count


@compiled("f8(f8[:,::1], f8[::1], i8, f8, f8)")
def _free_cost(word, terms, kind, amount, curvature):
    """The cost of a way on free ground, after a piece (kind, amount, curvature)."""
    cost = 0.0
    for k in range(len(word)):
        next_kind, next_amount, next_curvature = int(word[k, 0]), word[k, 1], word[k, 2]
        if abs(next_amount) < 1e-6:
            continue
        cost += change_cost(terms, kind, amount, curvature, next_kind, next_amount, next_curvature)
        length = abs(next_amount)
        if next_kind == TURN:
            length *= terms[TURNING]
        else:
            length *= (1.0 + terms[CURVING] * abs(next_curvature)) * (
                terms[REVERSE] if next_amount < 0.0 else 1.0)
        cost += length
        kind, amount, curvature = next_kind, next_amount, next_curvature
    return cost


@compiled(f8(VEHICLE, f8[::1], f8[::1]))
def free_way(vehicle: Vehicle, pose, goal):
    """The lowest cost from pose to goal on free ground, without cusps and changes of curvature."""
    words, terms = np.empty((WORDS, PIECES, 3)), vehicle.terms
    count = _curves(words, pose, goal, vehicle.radius, vehicle.reverse, vehicle.turns)
    best = np.inf
    for n in range(count):
        length = 0.0
        for k in range(PIECES):
            size = abs(words[n, k, 1]) * (terms[TURNING] if words[n, k, 0] == TURN else 1.0)
            length += size * (terms[REVERSE] if words[n, k, 1] < 0.0 and words[n, k, 0] == DRIVE
                              else 1.0)
        best = min(best, length)
    return best


@compiled(f8(GROUND, VEHICLE, f8[::1], f8[::1], i8, f8, f8, f8, f8[:,::1]))
def shoot(ground: Ground, vehicle: Vehicle, pose, goal, kind, amount, curvature, limit, found):
    """Cost of the cheapest free way to the goal below `limit`, of the TRIED most promising ones.

    `found` (PIECES, 3) gets its pieces; (kind, amount, curvature) is the piece that ends at `pose`.
    inf if there is none.
    """
    words, terms = np.empty((WORDS, PIECES, 3)), vehicle.terms
    count = _curves(words, pose, goal, vehicle.radius, vehicle.reverse, vehicle.turns)
    expected = np.empty(count)
    for n in range(count):
        expected[n] = _free_cost(words[n], terms, kind, amount, curvature)
    best = limit
    at, after = np.empty(3), np.empty(3)
    for _ in range(min(TRIED, count)):
        n = expected.argmin()
        if not expected[n] < best:
            break
        cost = 0.0
        at[:] = pose
        last_kind, last_amount, last_curvature = kind, amount, curvature
        for k in range(PIECES):
            next_kind, size, bend = int(words[n, k, 0]), words[n, k, 1], words[n, k, 2]
            if abs(size) < 1e-6:
                continue
            cost += change_cost(terms, last_kind, last_amount, last_curvature, next_kind, size,
                                bend)
            cost += cost_of(ground, vehicle, at, next_kind, size, bend, after)
            if cost >= best:
                break
            at[:] = after
            last_kind, last_amount, last_curvature = next_kind, size, bend
        expected[n] = np.inf
        if cost < best:
            best = cost
            found[:] = words[n]
    return best if best < limit else np.inf

"""navfn's planner: the cheapest path of a round robot's centre over the cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap.costs import INSCRIBED, Costmap
from nav_algorithms.global_planning.descent import descend
from nav_algorithms.global_planning.orientation import FORWARD, orient
from nav_algorithms.global_planning.potential import crossing_costs, spread, way_out

NEUTRAL, FACTOR = 50.0, 0.8  # cost of a free cell, and cost added per unit of the costmap's
UNKNOWN_COST = 253.0         # if unknown cells may be crossed


@dataclass(frozen=True)
class NavfnSettings:
    """Parameters of navfn/NavfnROS, except those of its window and its topics."""

    allow_unknown: bool
    default_tolerance: float  # m, how far from the goal a path may end, along x and y


def plan(costmap: Costmap, start: np.ndarray, goal: np.ndarray, tolerance: float | None = None,
         *, settings: NavfnSettings) -> np.ndarray | None:
    """Path (N, 3) from `start` to `goal`, poses in the costmap's frame; None if there is none.

    Points are half a cell apart or a little more; yaws are along the path, except at the start and
    the goal, whose own are kept. A start too near to an obstacle is left by the shortest way, at a
    high cost. With a `tolerance`, m, a goal that cannot be reached is replaced by the nearest point
    that can, in the square around it.
    """
    cost = crossing_costs(costmap.cells, NEUTRAL, FACTOR, INSCRIBED,
                          UNKNOWN_COST if settings.allow_unknown else np.inf)
    tolerance = settings.default_tolerance if tolerance is None else tolerance
    return plan_over(costmap, cost, start, goal, tolerance)


def plan_over(costmap: Costmap, cost: np.ndarray, start: np.ndarray, goal: np.ndarray,
              tolerance: float, quadratic: bool = True, heuristic: float = 0.0,
              across: bool = True) -> np.ndarray | None:
    """As `plan`, with any costs (rows, columns) of crossing, which change where a start is freed.

    `quadratic` and `heuristic` are those of `potential.spread`, `across` that of `descent.descend`.
    """
    first, last = costmap.cells_of(start[:2]), costmap.cells_of(goal[:2])
    if not costmap.contains(first) or (not costmap.contains(last) and tolerance <= 0.0):
        return None
    if costmap.cells[tuple(first)] >= INSCRIBED:
        out = way_out(costmap.cells, *first)
        cost[tuple(out.T)] = np.fmin(cost[tuple(out.T)], UNKNOWN_COST)
    potential = spread(cost, np.array([first]), np.zeros(1), *last, quadratic, heuristic,
                       4 * UNKNOWN_COST)
    if not costmap.contains(last) or potential[tuple(last)] == np.inf:
        near = _nearest_reached(costmap, potential, goal[:2], tolerance)
        if near is None:
            return None
        goal = np.array([*near, goal[2]])
    column, row = (np.asarray(goal[:2]) - costmap.origin) / costmap.resolution - 0.5
    points = descend(potential, column, row, across)
    if not len(points):
        return None
    path = np.zeros((len(points), 3))
    path[:, :2] = (points[::-1] + 0.5) * costmap.resolution + costmap.origin
    path[0], path[-1] = start, goal
    return orient(path, FORWARD)


def _nearest_reached(costmap: Costmap, potential: np.ndarray, goal: np.ndarray, tolerance: float
                     ) -> np.ndarray | None:
    """Centre (x, y), m, of the reached cell nearest to the goal, within the square around it."""
    if tolerance <= 0.0:
        return None
    cells = np.argwhere(np.isfinite(potential))
    offsets = costmap.centres_of(cells) - goal
    near = (np.abs(offsets) <= tolerance).all(axis=1)
    if not near.any():
        return None
    return goal + min(offsets[near], key=lambda offset: offset @ offset)

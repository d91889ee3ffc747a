"""Paths that a car can drive: hybrid A* over poses, forwards and backwards, with its footprint.

D. Dolgov, S. Thrun, M. Montemerlo, J. Diebel, "Path planning for autonomous vehicles in unknown
semi-structured environments" (2010): cells of (x, y, yaw) that each keep the exact pose of the
cheapest way there, and curves that are tried from there to the goal.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.footprint import Ground
from nav_algorithms.global_planning.motion_primitives import Vehicle, move, steps_of
from nav_algorithms.global_planning.potential import spread_everywhere
from nav_algorithms.global_planning.search import SearchLimits, search

TIGHT = 20.0  # cost, in free cells, of a cell within the inscribed radius, in the heuristic
LARGE = 1_000_000  # cells; on a larger map, a path near start and goal is searched for first
AROUND = 20.0      # m around start and goal


@dataclass(frozen=True)
class HybridAstarSettings:
    """What the vehicle can do and should avoid. Costs are in metres of free road."""

    allow_unknown: bool
    default_tolerance: float       # accepted, no effect: the goal is reached exactly or not
    minimum_turning_radius: float  # m
    allow_reverse: bool
    turn_in_place: bool            # differential drives: turns on the spot, and no curves
    state_resolution: float        # m, of the cells of poses
    yaw_bins: int                  # on the full circle
    primitive_length: float        # m, of one piece
    cost_penalty: float            # per metre, times the cell's cost / 252
    reverse_penalty: float         # factor per metre
    cusp_penalty: float            # per change between forwards and backwards
    curvature_penalty: float       # per metre and per 1/m of curvature
    swerve_penalty: float          # per 1/m of change of curvature
    turn_penalty: float            # per radian on the spot
    max_expansions: int            # about a second on a core of 2020
    improve_expansions: int        # after the first path was found


def plan(costmap: Costmap, start: np.ndarray, goal: np.ndarray, footprint: np.ndarray,
         settings: HybridAstarSettings) -> np.ndarray | None:
    """Path (N, 3) from `start` to `goal`, poses in the costmap's frame; None if there is none.

    Poses are at most a cell apart; the vehicle drives backwards where the next pose is behind it.
    `footprint` (K, 2), m, is free at each of them; if it seems to touch something at the start, it
    is shrunk until it fits there. The same input gives the same path: the time is limited by a
    number of steps, not by a clock. After these, the best path so far is returned.
    On a large costmap, a path near start and goal is preferred to a shorter one farther away.
    """
    start, goal = np.array(start, float), np.array(goal, float)
    footprint = np.ascontiguousarray(footprint, float)
    for part in _parts(costmap, start, goal):
        path = _plan_on(part, start, goal, footprint, settings)
        if path is not None:
            return path
    return None


def _parts(costmap: Costmap, start: np.ndarray, goal: np.ndarray) -> Iterator[Costmap]:
    """The surroundings in a large costmap, then all of it, which may cost seconds and GB."""
    if costmap.cells.size > LARGE:
        ends = costmap.cells_of(np.stack((start[:2], goal[:2])))
        if costmap.contains(ends).all():
            margin = int(AROUND / costmap.resolution)
            low = np.maximum(ends.min(axis=0) - margin, 0)
            row, column = np.minimum(ends.max(axis=0) + margin + 1, costmap.cells.shape)
            origin = np.array(costmap.origin) + low[::-1] * costmap.resolution
            yield Costmap(costmap.cells[low[0]:row, low[1]:column], costmap.resolution,
                          tuple(origin.tolist()))
    yield costmap


def _plan_on(costmap: Costmap, start: np.ndarray, goal: np.ndarray, footprint: np.ndarray,
             settings: HybridAstarSettings) -> np.ndarray | None:
    """As `plan`, on the whole costmap."""
    footprint = footprints.shrunk_to_fit(_known(costmap, settings), footprint, start)
    if footprint is None or not costmap.contains(costmap.cells_of(goal[:2])):
        return None
    s = settings
    estimate = _estimate(costmap, goal, s)
    if not np.isfinite(estimate[tuple(costmap.cells_of(start[:2]))]):
        return None
    ground = Ground.of(costmap, footprints.free_radii(_known(costmap, settings)), footprint)
    vehicle = Vehicle(float(s.minimum_turning_radius), s.allow_reverse, s.turn_in_place,
                      s.allow_unknown,
                      np.array([s.cost_penalty, s.reverse_penalty, s.cusp_penalty,
                                s.curvature_penalty, s.swerve_penalty, s.turn_penalty], float))
    limits = SearchLimits(float(max(s.state_resolution, costmap.resolution)), s.yaw_bins,
                          float(max(s.primitive_length, 1.45 * costmap.resolution)),
                          s.max_expansions, s.improve_expansions)
    pieces = search(ground, vehicle, estimate, start, goal, limits)
    return _driven(start, goal, pieces, costmap.resolution) if len(pieces) else None


def _known(costmap: Costmap, settings: HybridAstarSettings) -> Costmap:
    """The costmap with unknown cells free, if they may be crossed."""
    if not settings.allow_unknown:
        return costmap
    cells = np.where(costmap.cells == UNKNOWN, np.uint8(0), costmap.cells)
    return Costmap(cells, costmap.resolution, costmap.origin)


def _estimate(costmap: Costmap, goal: np.ndarray, settings: HybridAstarSettings) -> np.ndarray:
    """The cost from each cell to the goal, m of road, for a point that turns freely."""
    cells = costmap.cells.astype(float)
    crossing = 1.0 + settings.cost_penalty * cells / 252.0
    crossing[costmap.cells == INSCRIBED] = TIGHT
    crossing[costmap.cells == LETHAL] = np.inf
    crossing[costmap.cells == UNKNOWN] = 1.0 if settings.allow_unknown else np.inf
    source = np.array([costmap.cells_of(goal[:2])])
    return spread_everywhere(costmap.resolution * crossing, source, np.zeros(1))


def _driven(start: np.ndarray, goal: np.ndarray, pieces: np.ndarray, step: float) -> np.ndarray:
    """The poses (N, 3) of pieces (M, 3) driven one after another, ending exactly at the goal."""
    found = [start]
    for kind, amount, curvature in pieces:
        begin = found[-1]
        steps = steps_of(int(kind), amount, step)
        for n in range(1, steps + 1):
            pose = np.empty(3)
            move(begin, int(kind), amount * n / steps, curvature, pose)
            found.append(pose)
    path = np.array(found)
    path[-1] = goal
    path[:, 2] = (path[:, 2] + np.pi) % (2 * np.pi) - np.pi
    return path

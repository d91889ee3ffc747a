"""A global planner that considers costs: class Planner, on a costmap with a wall to go round."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import cv2
import numpy as np
from geometry_msgs.msg import PoseStamped

from exercises.finding import Finding, Mistake, at_most, holds
from exercises.program import load, part
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, Costmap

CELL, SIDE = 0.05, 100  # m; cells along each side of the room
WALL = slice(45, 55), slice(0, 60)  # rows, columns
INSCRIBED_M, DECAY = 0.2, 3.0  # inscribed radius, m; decay of the cost beyond it, 1/m
START, GOAL = (-1.5, -1.5), (-1.5, 1.5)  # m
CALL = "Planner().make_plan(start, goal)"


def costmap(walls: tuple[tuple[slice, slice], ...]) -> Costmap:
    """The room's costmap with these cells occupied, inflated."""
    free = np.ones((SIDE, SIDE), np.uint8)
    free[0], free[-1], free[:, 0], free[:, -1] = 0, 0, 0, 0
    for wall in walls:
        free[wall] = 0
    away = cv2.distanceTransform(free, cv2.DIST_L2, 5) * CELL
    cells = np.where(away < INSCRIBED_M, INSCRIBED,
                     252 * np.exp(-DECAY * (away - INSCRIBED_M))).astype(np.uint8)
    cells[free == 0] = LETHAL
    half = SIDE * CELL / 2
    return Costmap(cells, CELL, (-half, -half))


def plan(module, grid: Costmap) -> np.ndarray:
    """The path (N, 2), m; Mistake if the planner returns no list of poses."""
    planned = part(module, "Planner()")()
    planned.initialize("Planner", SimpleNamespace(snapshot=lambda: grid))
    poses = [PoseStamped(), PoseStamped()]
    for pose, (x, y) in zip(poses, (START, GOAL)):
        pose.header.frame_id, pose.pose.orientation.w = "map", 1.0
        pose.pose.position.x, pose.pose.position.y = x, y
    answer = planned.make_plan(*poses)
    if not isinstance(answer, list) or not all(isinstance(p, PoseStamped) for p in answer):
        raise Mistake(f"{CALL} answered {str(answer)[:60]!r}, wanted a list of PoseStamped")
    return np.array([(p.pose.position.x, p.pose.position.y) for p in answer]).reshape(-1, 2)


def planner(file: Path, limits: dict[str, float]) -> Iterator[Finding]:
    """A path without gaps and contacts, at low cost, not much longer; none if there is none."""
    module, grid = load(file), costmap((WALL,))
    path = plan(module, grid)
    ends = len(path) > 1 and np.allclose(path[[0, -1]], (START, GOAL), atol=CELL)
    yield holds("the path's ends", f"{len(path)} poses", "from start to goal", ends)
    if not ends:
        return
    steps = np.hypot(*np.diff(path, axis=0).T)
    costs = grid.cells[tuple(grid.cells_of(path).T)]
    yield at_most("longest step", steps.max(), 3 * CELL, " m")
    yield at_most("largest cost on the way", costs.max(), INSCRIBED - 1)
    yield at_most("mean cost on the way", costs.mean(), limits["cost"])
    shortest = np.hypot(*np.diff(plan(module, costmap(())), axis=0).T).sum()
    yield at_most("way in an empty room, times the straight one",
                  shortest / np.hypot(*np.subtract(GOAL, START)), limits["way_share"])
    closed = len(plan(module, costmap(((WALL[0], slice(0, SIDE)),))))
    yield holds("poses where no way leads through", str(closed), "0", closed == 0)

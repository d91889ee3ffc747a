"""The common part of the local planners: a path, its end, and a footprint that fits.

Also what some of them share: no oscillation (after a reversal, the direction may not be reversed
again on the spot), and the distance of each cell of a local costmap from the path or a target.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import INSCRIBED, LETHAL, UNKNOWN, Costmap
from nav_algorithms.global_planning.potential import spread_everywhere
from nav_algorithms.local_planning.following import STANDSTILL, Following, within
from nav_algorithms.local_planning.goal import Arrival, StopAndTurn
from nav_algorithms.local_planning.velocities import Command, Limits
from nav_algorithms.poses import wrap_angle

TIGHT = 20.0  # cost, in free cells, of a cell where the robot's centre should not be
GROWTH, LARGEST = 2.0, 3.0  # of the angle, rad; differences are at most half a turn


def distances_to(costmap: Costmap, points: np.ndarray, passable: np.ndarray) -> np.ndarray:
    """Way from each cell to the nearest of the points (N, 2), in cells (rows, columns); inf: none.

    The way leads around obstacles; cells of `passable` (M, 2) are free whatever is in them, as in
    base_local_planner's map grid, where the path is trusted more than the costmap.
    """
    crossing = np.ones(costmap.cells.shape)
    crossing[costmap.cells >= INSCRIBED] = TIGHT
    crossing[(costmap.cells == LETHAL) | (costmap.cells == UNKNOWN)] = np.inf
    cells = costmap.cells_of(passable)
    crossing[tuple(cells[costmap.contains(cells)].T)] = 1.0
    sources, seeds = _around(costmap, points)
    passable = np.isfinite(crossing[tuple(sources.T)])
    return spread_everywhere(crossing, np.ascontiguousarray(sources[passable]), seeds[passable])


def _around(costmap: Costmap, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells (S, 2) of the points and next to them, and their distance from the point, in cells."""
    beside = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1], indexing="ij"), axis=-1).reshape(-1, 2)
    cells = (costmap.cells_of(points).reshape(-1, 1, 2) + beside)
    away = (costmap.centres_of(cells) - np.asarray(points).reshape(-1, 1, 2)) / costmap.resolution
    inside = costmap.contains(cells)
    return cells[inside], np.hypot(away[..., 0], away[..., 1])[inside]


class Oscillation:
    """Per axis, the sign of the last motion, and the only sign allowed until the robot has moved.

    As dwa_local_planner's flags: forward and backward always count, strafing and turning only
    if the robot does not drive. Unlike there, the angle that counts as a move grows each time the
    robot has only turned: it looks farther round instead of oscillating for ever.
    """

    def __init__(self, reset_distance: float, reset_angle: float) -> None:
        """The robot has moved after `reset_distance`, m, or `reset_angle`, rad."""
        self.reset_distance, self.reset_angle = reset_distance, reset_angle
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self._begin_anew()
        self.angle = self.reset_angle
        self.spot = np.zeros(2)  # where the robot has only turned

    def _begin_anew(self) -> None:
        self.last = np.zeros(3)
        self.only = np.zeros(3)
        self.where = np.zeros(3)

    def allowed(self, samples: np.ndarray) -> np.ndarray:
        """Which of the samples (S, 3) are allowed, bool (S,)."""
        return (samples * self.only >= 0.0).all(axis=1)

    def took(self, velocity: np.ndarray, pose: np.ndarray, min_vel_trans: float) -> None:
        """Remember the command at `pose`."""
        turned = False
        for axis in range(3):
            if axis and abs(velocity[0]) > min_vel_trans:
                continue
            sign = np.sign(velocity[axis])
            if sign and self.last[axis] == -sign:
                self.only[axis], turned = sign, True
            if sign:
                self.last[axis] = sign
        if turned:
            self.where = np.array(pose, float)

    def at(self, pose: np.ndarray) -> None:
        """Take the robot's pose: far enough from where it reversed, everything is allowed."""
        if np.hypot(*(pose[:2] - self.spot)) > self.reset_distance:
            self.angle, self.spot = self.reset_angle, pose[:2].copy()
        if not self.only.any():
            return
        if np.hypot(*(pose[:2] - self.where[:2])) > self.reset_distance:
            self._begin_anew()
        elif abs(wrap_angle(pose[2] - self.where[2])) > self.angle:
            self._begin_anew()
            self.angle = min(GROWTH * self.angle, LARGEST)


class LocalPlanner(ABC):
    """Follows one path; `set_path` begins a new one. Subclasses choose the velocity.

    Upstream's planners forget with every plan which way they turned last, and whether the position
    was right already; with five plans per second they oscillate.
    """

    def __init__(self, arrival: Arrival, oscillation: Oscillation) -> None:
        self.end = StopAndTurn(arrival)
        self.oscillation = oscillation
        self.following: Following | None = None

    def set_path(self, path: np.ndarray, again: bool = False) -> None:
        """Path (N, 3), poses in a fixed frame. Raises ValueError for an invalid path.

        `again`: the goal is the same as before.
        """
        self.following = Following(path)
        if not again:
            self.oscillation.reset()
            self.end.reset()

    def reached(self, pose: np.ndarray, velocity: np.ndarray,
                path_frame: np.ndarray = STANDSTILL) -> bool:
        """Whether the robot stands at the goal; arguments as in `command`."""
        return self.following is not None and self.end.reached(
            pose, velocity, self.following.goal(path_frame))

    def command(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
                velocity: np.ndarray, path_frame: np.ndarray = STANDSTILL) -> Command | None:
        """The next velocity, within `limits`; None if all possible ones collide or lead nowhere, or
        if `velocity` is not finite.

        `pose` (3,) in the costmap's frame; `velocity` (3,) in the base frame; `footprint` (K, 2);
        `path_frame`: pose of the path's frame in the costmap's.
        """
        if self.following is None:
            return None
        pose, velocity = np.array(pose, float), np.array(velocity, float)
        if not np.isfinite(velocity).all():
            return None
        found = self._next(costmap, footprint, pose, velocity, path_frame)
        return None if found is None else found.within(self.limits())

    def _next(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              velocity: np.ndarray, path_frame: np.ndarray) -> Command | None:
        """A command on the way or at its end; braking, it may still exceed the limits."""
        path = self.following.left(pose, path_frame)
        footprint = footprints.shrunk_to_fit(costmap, np.asarray(footprint, float), pose)
        if footprint is None:
            return None
        if self.end.at_place(pose, path[-1]):
            return self.end.command(costmap, footprint, pose, velocity, path[-1])
        near = within(costmap, path)
        if not len(near):
            return None
        self.oscillation.at(pose)
        best = self._best(costmap, footprint, pose, velocity, near, path[-1])
        if best is None:
            self.oscillation.reset()  # its constraint may exclude the only way out
        return best

    @abstractmethod
    def limits(self) -> Limits:
        """Limits that are never exceeded."""

    @abstractmethod
    def _best(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              velocity: np.ndarray, near: np.ndarray, goal: np.ndarray) -> Command | None:
        """The velocity to take. `near` (M, 3) is the path in the costmap, `goal` (3,) its end."""

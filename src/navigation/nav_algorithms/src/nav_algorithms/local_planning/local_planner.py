"""The common part of the local planners: a path, its end, and a footprint that fits."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.following import STANDSTILL, Following, within
from nav_algorithms.local_planning.goal import Arrival, StopAndTurn
from nav_algorithms.local_planning.oscillation import Oscillation
from nav_algorithms.local_planning.velocities import Command, Limits


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

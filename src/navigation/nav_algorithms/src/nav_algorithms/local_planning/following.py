"""The path that a local planner follows: the rest of it from the robot on."""

from __future__ import annotations

import numpy as np

from nav_algorithms.costmap.costs import UNKNOWN, Costmap
from nav_algorithms.poses import compose

AHEAD = 1.0  # m along the path that are searched for the robot's position
STANDSTILL = np.zeros(3)


class Following:
    """A path (N, 3) in a fixed frame and how far along it the robot is."""

    def __init__(self, path: np.ndarray) -> None:
        """Raises ValueError for an invalid path."""
        path = np.array(path, float)
        if path.ndim != 2 or path.shape[1:] != (3,) or not len(path) or not np.isfinite(path).all():
            raise ValueError(f"a path is (N, 3), finite and not empty, not {path.shape}")
        self.path = path
        self.lengths = np.append(0.0, np.cumsum(np.hypot(*np.diff(path[:, :2], axis=0).T)))
        self.at = 0

    def left(self, pose: np.ndarray, path_frame: np.ndarray = STANDSTILL) -> np.ndarray:
        """The path (M, 3) from next to the robot to the goal, in the costmap's frame.

        `path_frame` is the pose of the path's frame in the costmap's. The place on the path never
        goes back, nor to another part of the path that happens to come near.
        """
        path = compose(np.asarray(path_frame, float), self.path[self.at:])
        near = self.lengths[self.at:] <= self.lengths[self.at] + AHEAD
        self.at += int(np.hypot(*(path[near, :2] - pose[:2]).T).argmin())
        return path[len(path) - (len(self.path) - self.at):]

    def goal(self, path_frame: np.ndarray = STANDSTILL) -> np.ndarray:
        """The last pose (3,) in the costmap's frame."""
        return compose(np.asarray(path_frame, float), self.path[-1])


def within(costmap: Costmap, path: np.ndarray) -> np.ndarray:
    """The first part of the path (M, 3) on known cells of the costmap; may be empty."""
    cells = costmap.cells_of(path[:, :2])
    inside = costmap.contains(cells)
    inside[inside] = costmap.cells[tuple(cells[inside].T)] != UNKNOWN
    if not inside.any():
        return path[:0]
    first = int(inside.argmax())
    after = np.nonzero(~inside[first:])[0]
    return path[first:first + (int(after[0]) if len(after) else len(path))]

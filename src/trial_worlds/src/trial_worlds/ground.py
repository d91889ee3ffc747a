"""The true house: its walls, where a robot has room, and shortest paths through it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bullet_sim.errors import SimulationError
from nav_algorithms.costmap.costs import FREE, INSCRIBED, Costmap
from nav_algorithms.global_planning import navfn
from nav_algorithms.grid import OCCUPIED
from nav_algorithms.likelihood_field import distances
from nav_algorithms.poses import wrap_angle
from trial_worlds.errors import WorldError
from trial_worlds.feelers import Feelers
from trial_worlds.true_map import open_walls, reached, true_map

MOST_DRAWS = 10_000  # attempts to draw one goal


class Ground:
    """True walls of a house, read from its world file; all poses in the world's frame."""

    def __init__(self, world: Path, start: tuple[float, float, float], laser_height: float,
                 passable: float, goal_clearance: float, goal_distance: float):
        """Least distances in m: `passable` and `goal_clearance` from a wall, `goal_distance` from
        goal to goal. WorldError if the file is not a world with walls around `start`.
        """
        self._start = start
        self._goal_clearance, self._goal_distance = goal_clearance, goal_distance
        try:
            self._world = open_walls(world)
            self.walls = true_map(self._world, laser_height, [start[:2]])
        except (SimulationError, OSError, ValueError) as error:
            raise WorldError(f"{world}: {error}") from error
        self._clearance = distances(
            (self.walls.cells == OCCUPIED).astype(np.uint8)) * self.walls.resolution
        start = self.walls.cells_of(np.array([start[:2]]))
        self._within = reached(self._clearance < passable, start)
        self._costs = Costmap(np.where(self._within, FREE, INSCRIBED).astype(np.uint8),
                              self.walls.resolution, self.walls.origin)

    def feelers(self, urdf: str) -> Feelers:
        """Feelers of the robot that this URDF describes, in this house."""
        return Feelers(self._world, urdf)

    def has_room(self, point: np.ndarray) -> bool:
        """Whether the robot can get to this point (x, y) from its start."""
        cell = self.walls.cells_of(np.asarray(point, float))
        return bool(self.walls.contains(cell) and self._within[tuple(cell)])

    def draw_goals(self, count: int, seed: int) -> np.ndarray:
        """Random poses (count, 3), uniform over the free space; WorldError if there is too little.

        A longer list begins with the goals of a shorter one.
        """
        generator = np.random.default_rng(seed)
        cells = np.argwhere(self._within & (self._clearance >= self._goal_clearance))
        goals: list[np.ndarray] = []
        before = np.array(self._start)
        while len(goals) < count:
            before = self._draw_goal(generator, cells, before)
            goals.append(before)
        return np.array(goals).reshape(-1, 3)

    def shortest_way(self, start: np.ndarray, goal: np.ndarray) -> float:
        """Length (m) of the shortest path between two poses without touching a wall; inf: none."""
        path = navfn.plan(self._costs, np.asarray(start, float), np.asarray(goal, float),
                          settings=navfn.NavfnSettings(allow_unknown=True, default_tolerance=0.0))
        if path is None:
            return np.inf
        return float(np.linalg.norm(np.diff(path[:, :2], axis=0), axis=1).sum())

    def _draw_goal(self, generator: np.random.Generator, cells: np.ndarray,
                   before: np.ndarray) -> np.ndarray:
        for _ in range(MOST_DRAWS if len(cells) else 0):
            place = self.walls.centres_of(cells[generator.integers(len(cells))])
            yaw = wrap_angle(generator.uniform(-np.pi, np.pi))
            if np.linalg.norm(place - before[:2]) >= self._goal_distance:
                return np.array([*place, yaw])
        raise WorldError(f"no room for a goal {self._goal_clearance:g} m from all walls and "
                       f"{self._goal_distance:g} m from the last: change the house file")

"""The true map of a world at the height of a laser; where a robot has room; shortest paths."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import rospkg
from scipy import ndimage

from bullet_sim.errors import SimulationError
from bullet_sim.formats.loading import load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.world import World
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.costmap.costs import FREE as FREE_COST
from nav_algorithms.costmap.costs import INSCRIBED, Costmap
from nav_algorithms.global_planning import navfn
from nav_algorithms.likelihood_field import distances
from nav_algorithms.poses import wrap_angle
from nav_algorithms.rays import cast
from trial_worlds.errors import WorldError
from trial_worlds.feelers import Feelers

LINES_A_CELL = 4  # rays side by side in one cell, so that none misses a corner
BEYOND = 1e-4     # m behind a surface, to decide its cell at a border, and to start the next ray
MOST_SURFACES = 1000  # one behind the other on a line


def open_walls(path: Path | str) -> World:
    """The world of a file without its actors, in its initial state; close it after use.

    Models are sought in the folder `models` beside the file's own folder, and in Gazebo's usual
    places. Raises bullet_sim.errors.SimulationError if the file is not a world.
    """
    path = Path(path)
    resources = Resources.from_environment(
        os.environ, extra_model_paths=[path.resolve().parent.parent / "models"],
        find_package=rospkg.RosPack().get_path)
    description = load_world(path, resources)
    return World(replace(description, models=tuple(
        model for model in description.models if model.trajectory is None)))


def true_map(world: World, height: float, inside: Sequence[tuple[float, float]],
             resolution: float = 0.05, reach: float = 30.0) -> OccupancyGrid:
    """Walls at `height`, m, in the world's frame, within `reach` m of its origin on each side.

    A cell is FREE if it can be reached from a point of `inside` (x, y) without crossing a collision
    surface; OCCUPIED if it is next to a free cell and contains a surface, as hit from outside by
    rays along x and y; else UNKNOWN, such as the inside of walls. The grid ends one cell beyond the
    outermost surface. Raises ValueError if there is no surface, or if a point of `inside` is in a
    wall or outside of all walls.
    """
    count = round(reach / resolution)
    points = np.concatenate([_surfaces(world, axis, height, count * resolution, resolution)
                             for axis in (0, 1)])
    if not len(points):
        raise ValueError(f"no surface at {height:g} m within {reach:g} m of the world's origin")
    cells = np.floor(points / resolution).astype(int)  # x, y, counted from the world's origin
    low, high = cells.min(axis=0) - 1, cells.max(axis=0) + 2
    surface = np.zeros((high - low)[::-1], bool)
    surface[tuple((cells - low).T[::-1])] = True
    grid = OccupancyGrid(np.full(surface.shape, UNKNOWN, np.int8), resolution,
                         tuple((low * resolution).tolist()))
    starts = grid.cells_of(np.array(inside))
    for point, cell in zip(inside, starts, strict=True):
        if not grid.contains(cell) or surface[tuple(cell)]:
            raise ValueError(f"{point} is in a wall, or outside all of them")
    free = reached(surface, starts)
    beside = ndimage.binary_dilation(free, np.ones((3, 3), bool))
    found = np.where(free, FREE, np.where(surface & beside, OCCUPIED, UNKNOWN))
    return replace(grid, cells=found.astype(np.int8))


def reached(closed: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Bool (rows, columns): cells connected to one of `starts` (N, 2), row and column.

    Cells connect over a common side, never into one that is `closed`, bool (rows, columns).
    """
    parts, _ = ndimage.label(~closed)
    inside = starts[((starts >= 0) & (starts < closed.shape)).all(axis=1)]
    numbers = parts[tuple(inside.T)]
    return np.isin(parts, numbers[numbers > 0])


def visible_walls(grid: OccupancyGrid, poses: np.ndarray, angles: np.ndarray,
                  range_max: float) -> np.ndarray:
    """The OCCUPIED cells in which a beam ends, bool (rows, columns).

    The laser was at `poses` (N, 3), with beams at `angles` (M,), rad, from each heading.
    """
    occupied = (grid.cells == OCCUPIED).astype(np.uint8)
    seen = np.zeros(grid.cells.shape, bool)
    for x, y, yaw in np.asarray(poses, float):
        directions = yaw + np.asarray(angles, float)
        ranges = cast(occupied, grid.resolution, *grid.origin, x, y, directions, range_max)
        hit = np.isfinite(ranges)
        ways = (ranges[hit] + BEYOND * grid.resolution)[:, None]
        beams = np.stack((np.cos(directions[hit]), np.sin(directions[hit])), axis=1)
        cells = grid.cells_of([x, y] + ways * beams)
        cells = cells[grid.contains(cells)]
        seen[cells[:, 0], cells[:, 1]] = True
    return seen & (occupied == 1)


def _surfaces(world: World, axis: int, height: float, reach: float,
              resolution: float) -> np.ndarray:
    """Points (N, 2), m, just behind the surfaces hit by rays along an axis, in both directions."""
    spacing = resolution / LINES_A_CELL
    across = np.arange(-reach + spacing / 2, reach, spacing)
    found = []
    for sign in (1.0, -1.0):
        starts = np.empty((len(across), 3))
        starts[:, axis], starts[:, 1 - axis], starts[:, 2] = -sign * reach, across, height
        for _ in range(MOST_SURFACES):
            ends = starts.copy()
            ends[:, axis] = sign * reach
            fraction = world.cast_rays(starts, ends).fraction[:, None]
            ways = fraction * (ends - starts)
            # A ray that begins inside a sphere hits it again immediately, all the way through.
            again = np.abs(ways[:, axis]) < BEYOND
            ways[:, axis] += sign * np.where(again, spacing, BEYOND)
            starts, again = (starts + ways)[fraction[:, 0] < 1], again[fraction[:, 0] < 1]
            within = sign * starts[:, axis] < reach
            starts, again = starts[within], again[within]
            if not len(starts):
                break
            found.append(starts[~again, :2])
    return np.concatenate(found) if found else np.empty((0, 2))


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
        self._costs = Costmap(np.where(self._within, FREE_COST, INSCRIBED).astype(np.uint8),
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

"""The layer of sensor data: obstacles where rays end, free cells along the rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap.costs import FREE, LETHAL, UNKNOWN, Costmap
from nav_algorithms.costmap.layer import MAXIMUM, Bounds, Layer, Window, combine, shifted
from nav_algorithms.costmap.tracing import draw_lines, fill_polygon
from nav_algorithms.poses import transform_points


@dataclass(frozen=True)
class Observation:
    """One observation of one sensor, in the costmap's frame, m.

    `points` (N, 3) are the ends of its rays, `origin` (3,) is their start. Points nearer than
    `obstacle_range` become obstacles; rays clear the cells up to `raytrace_range`.
    """

    origin: np.ndarray
    points: np.ndarray
    obstacle_range: float
    raytrace_range: float


class ObstacleLayer(Layer):
    """Remembers obstacles until a ray passes through them, as costmap_2d's ObstacleLayer."""

    from_sensors = True

    def __init__(self, name: str, track_unknown: bool = False, combination_method: int = MAXIMUM,
                 max_obstacle_height: float = 2.0, clears_footprint: bool = True) -> None:
        """`max_obstacle_height`, m: higher points are ignored; the others as in costmap_2d."""
        super().__init__(name)
        self.combination_method = combination_method
        self.max_obstacle_height = max_obstacle_height
        self.clears_footprint = clears_footprint
        self.own: Costmap | None = None
        self._default = UNKNOWN if track_unknown else FREE
        self._marking: Sequence[Observation] = ()
        self._clearing: Sequence[Observation] = ()
        self._footprint = np.zeros((0, 2))
        self._outline = np.zeros((0, 2))
        self._all_is_new = False

    def match(self, master: Costmap) -> None:
        """Start again in the master's size."""
        self.own = Costmap(np.full(master.cells.shape, self._default, np.uint8),
                           master.resolution, master.origin)

    def shift(self, rows: int, columns: int, origin: tuple[float, float]) -> None:
        """Obstacles keep their place in the world."""
        self.own = Costmap(shifted(self.own.cells, rows, columns, self._default),
                           self.own.resolution, origin)

    def set_footprint(self, footprint: np.ndarray) -> None:
        """The cells below the robot are free."""
        self._footprint = np.asarray(footprint, float)

    def observe(self, marking: Sequence[Observation], clearing: Sequence[Observation]) -> None:
        """Set the observations for the next update, which clears before it marks."""
        self._marking, self._clearing = marking, clearing

    def update_bounds(self, pose: np.ndarray, bounds: Bounds) -> None:
        """Clear, then mark, then find where the robot stands."""
        if not self.enabled:
            return
        if self._all_is_new:
            bounds.add_all()
            self._all_is_new = False
        for observation in self._clearing:
            self._clear(observation, bounds)
        for observation in self._marking:
            self._mark(observation, bounds)
        self._outline = transform_points(pose, self._footprint)
        if self.clears_footprint:
            bounds.add(self._outline)

    def update_costs(self, master: Costmap, window: Window) -> None:
        """Free the cells below the robot and combine this layer into the master."""
        if not self.enabled:
            return
        if self.clears_footprint and len(self._outline) > 2:
            fill_polygon(self.own.cells, self._in_cells(self._outline), FREE)
        combine(master.cells[window], self.own.cells[window], self.combination_method)

    def reset(self) -> None:
        """Forget all obstacles."""
        self.match(self.own)
        self._all_is_new = True

    def clear_area(self, low: np.ndarray, high: np.ndarray, invert: bool = False) -> None:
        """Forget everything outside (inverted: inside) the rectangle from `low` to `high`, m."""
        self._forget(_forgotten(self.own, low, high, invert))
        self._all_is_new = True

    def _forget(self, forgotten: np.ndarray) -> None:
        self.own.cells[forgotten] = UNKNOWN

    def _in_cells(self, points: np.ndarray) -> np.ndarray:
        return (points - self.own.origin) / self.own.resolution

    def _clear(self, observation: Observation, bounds: Bounds) -> None:
        start = np.asarray(observation.origin[:2], float)
        ends = _cut(start, observation.points[:, :2], observation.raytrace_range)
        if not len(ends):
            return
        bounds.add(start)
        bounds.add(ends)
        row, column = self.own.cells_of(start).tolist()
        rows, columns = np.ascontiguousarray(self.own.cells_of(ends).T)
        draw_lines(self.own.cells, row, column, rows, columns, FREE)

    def _mark(self, observation: Observation, bounds: Bounds) -> None:
        points = self._obstacles(observation)
        cells = self.own.cells_of(points[:, :2])
        inside = self.own.contains(cells)
        self.own.cells[tuple(cells[inside].T)] = LETHAL
        bounds.add(points[inside, :2])

    def _obstacles(self, observation: Observation) -> np.ndarray:
        """Its points (M, 3) that are near and low enough."""
        points = observation.points
        near = ((points - observation.origin) ** 2).sum(axis=1) < observation.obstacle_range ** 2
        return points[near & (points[:, 2] <= self.max_obstacle_height)]


def _cut(start: np.ndarray, ends: np.ndarray, reach: float) -> np.ndarray:
    """Ends (N, D) of rays from `start` (D,), cut at the distance `reach`."""
    way = ends - start
    lengths = np.sqrt((way ** 2).sum(axis=1))
    return start + way * np.minimum(1.0, reach / np.maximum(lengths, 1e-9))[:, None]


def _forgotten(costmap: Costmap, low: np.ndarray, high: np.ndarray, invert: bool) -> np.ndarray:
    """Which cells, bool (rows, columns), are outside (inverted: inside) a rectangle, m."""
    rows, columns = costmap.cells.shape
    x = (np.arange(columns) + 0.5) * costmap.resolution + costmap.origin[0]
    y = (np.arange(rows) + 0.5) * costmap.resolution + costmap.origin[1]
    inside = np.outer((y > low[1]) & (y < high[1]), (x > low[0]) & (x < high[0]))
    return inside if invert else ~inside

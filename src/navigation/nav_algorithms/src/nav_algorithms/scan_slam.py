"""SLAM from scans alone: each scan is matched to the map of the earlier ones.

The use is that of S. Kohlbrecher et al., "A flexible and scalable SLAM system with full 3D motion
estimation" (2011): no odometry, a map of fixed size, and a scan is added to it after some way or
turn. The matching is scan_matching's, about the pose at which constant velocity puts the robot.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nav_algorithms import poses
from nav_algorithms.beam_walls import holds
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.hit_maps import HitMaps
from nav_algorithms.map_rendering import MapRendering
from nav_algorithms.scan_matching import refine, search

CHANGE = np.array([0.4, 0.4, 0.85])  # m/s, m/s, rad/s; deviation of a scan's velocity from the last
SURE = np.array([0.02, 0.02, 0.03])  # m, m, rad; deviation that remains, however short the time
LONGEST = 0.4       # s; after a longer time the deviation no longer grows
SEARCHED = 2.5      # deviations, to either side, that a search covers
CELL = 0.05         # m; of the map that scans are matched to, whatever the drawn map's cells are
STEPS = np.array([0.1, 0.1, 0.05])  # m, m, rad; of a search; then half of it, about the best
SEARCH_BEAMS = 60   # enough for a search
ITERATIONS = 10     # of the refinement, at most
KERNEL = 1          # cells to either side in which a beam's wall is searched for
WIDTHS = np.array([1.0, 1.0, 0.25])  # in cells, as in scan_matching: 5 cm, and 1 cm of what fits
SCALE = np.array([CELL, CELL, 1.0])  # of poses in cells
LEAST_SHARE = 0.2   # of the beams that must end at known walls for a match to count


@dataclass(frozen=True)
class ScanSlamSettings:
    """hector_mapping's parameters by its names; m, rad."""

    map_resolution: float
    map_size: int
    map_start_x: float
    map_start_y: float
    update_factor_free: float
    update_factor_occupied: float
    map_update_distance_thresh: float
    map_update_angle_thresh: float


class ScanSlam:
    """Maps and localises without odometry; begins at (0, 0, 0). The same scans give the same bits.

    `pose` (x, y, yaw) and `covariance` (3, 3), m and rad, are those of the newest scan.
    """

    def __init__(self, settings: ScanSlamSettings) -> None:
        self.settings = settings
        lower = -settings.map_size * settings.map_resolution * np.array(
            [settings.map_start_x, settings.map_start_y])
        upper = lower + settings.map_size * settings.map_resolution
        self._bounds = np.array([lower, upper])
        self._hits = HitMaps(1, CELL, lower, upper)
        self._rendering = MapRendering(settings.map_resolution, lower, upper, grows=False)
        free, occupied = (math.log(p / (1.0 - p)) for p in (settings.update_factor_free,
                                                             settings.update_factor_occupied))
        self._threshold = free / (free - occupied)  # where hits and passes weigh the same
        self._added: np.ndarray | None = None  # where the newest scan of the map was taken
        self._stamp = 0.0
        self._velocity = np.zeros(3)  # in the robot's frame; m/s, m/s, rad/s
        self.pose = np.zeros(3)
        self.covariance = np.zeros((3, 3))

    def add(self, stamp: float, ends: np.ndarray, ranges: np.ndarray, width: float,
            laser: np.ndarray, guess: np.ndarray | None = None) -> bool:
        """Moves the pose to where a scan fits the map; False, and it stays, if it fits nowhere.

        `stamp`, s; `ends` (N, 2), m, of the beams that hit, in the robot's frame and sorted by
        angle; their lengths `ranges` (N,), m; `width`, rad, between beams; `laser` (x, y), m, on
        the robot. `guess` (3,): about where the robot is, if that is known.
        """
        after = float(np.clip(stamp - self._stamp, 0.0, LONGEST))
        self._stamp = stamp
        if self._added is None:
            self.pose = self.pose if guess is None else np.array(guess, float)
        elif not self._match(ends, ranges, width, after, guess):
            return False
        if self._is_due() and len(ends) and self._is_inside():
            self._hits.add(self.pose[None], ends)
            self._rendering.count(self.pose, (ends, np.ones(len(ends), bool)), laser)
            self._added = self.pose
        return True

    def place(self, pose: np.ndarray) -> None:
        """Continue from another pose (3,), on the same map."""
        self.pose, self._velocity = np.array(pose, float), np.zeros(3)

    def grid(self) -> OccupancyGrid:
        """The map, map_size x map_size cells."""
        return self._rendering.grid(self._threshold)

    def _is_inside(self) -> bool:
        """Whether the robot is on the map, which ends somewhere."""
        return bool((self._bounds[0] <= self.pose[:2]).all()
                    and (self.pose[:2] < self._bounds[1]).all())

    def _is_due(self) -> bool:
        if self._added is None:
            return True
        x, y, turn = poses.relative(self._added, self.pose)
        return (np.hypot(x, y) > self.settings.map_update_distance_thresh
                or abs(turn) > self.settings.map_update_angle_thresh)

    def _match(self, ends: np.ndarray, ranges: np.ndarray, width: float, after: float,
               guess: np.ndarray | None) -> bool:
        prior = (poses.compose(self.pose, self._velocity * after) if guess is None
                 else np.array(guess, float))
        beams = np.hstack((ends / CELL, holds(ends, ranges, width)))
        maps = self._hits.tables[0], self._hits.pool, np.ascontiguousarray(beams)
        spread, stride = SURE + CHANGE * after, max(1, len(beams) // SEARCH_BEAMS)
        information = np.diag((SCALE / spread) ** 2)
        start, coarse, found = self._hits.in_cells(prior[None])[0], np.empty(3), np.empty(3)
        search(*maps, start, information, np.ceil(SEARCHED * spread / STEPS).astype(np.int64),
               STEPS / SCALE, stride, coarse)
        search(*maps, coarse, 0.0 * information, np.ones(3, np.int64), 0.5 * STEPS / SCALE, stride,
               found)
        lower = np.empty((3, 3))
        _, score = refine(*maps, start, information, found, ITERATIONS, KERNEL, WIDTHS, lower)
        if score < max(1.0, LEAST_SHARE * len(beams)):
            self._velocity = np.zeros(3)
            return False
        found[:2] = found[:2] * CELL + self._hits.origin
        found[2] = poses.wrap_angle(found[2])
        inverse = np.linalg.inv(lower) * SCALE
        self.covariance = inverse.T @ inverse
        if after > 0.0:
            self._velocity = poses.relative(self.pose, found) / after
        self.pose = found
        return True

"""A ring of corridors, a drive round it, and what odometry and laser make of it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from nav_algorithms import poses, rays
from nav_algorithms.particle_slam import ParticleSlam

CELL = 0.02            # m; the world's own cells are finer than the map's
ORIGIN = (-1.0, -1.0)  # m
ANGLES = np.arange(360) * 2 * np.pi / 360
RANGE_MAX = 3.5        # m
PERIOD = 0.2           # s between scans
# (x0, y0, x1, y1), m: four outer walls, the block inside the ring, and what stands at the walls.
BOXES = ((-0.2, -0.2, 14.2, 0.0), (-0.2, 8.0, 14.2, 8.2), (-0.2, -0.2, 0.0, 8.2),
         (14.0, -0.2, 14.2, 8.2), (2.0, 2.0, 12.0, 6.0), (2.2, 0.0, 2.5, 0.25),
         (5.0, 0.0, 5.3, 0.25), (7.5, 0.0, 7.8, 0.25), (10.6, 0.0, 10.9, 0.25),
         (3.5, 7.8, 3.75, 8.0), (6.6, 7.8, 6.85, 8.0), (9.7, 7.8, 9.95, 8.0),
         (13.7, 3.0, 14.0, 3.4), (13.7, 5.0, 14.0, 5.4), (0.0, 3.6, 0.2, 3.9), (0.0, 5.6, 0.2, 5.9))
RING = ((1, 1), (13, 1), (13, 7), (1, 7), (1, 1), (5, 1))  # once round and on: 40 m


@dataclass(frozen=True)
class RecordedDrive:
    """True poses (N, 3), the odometry's (N, 3), and scans (N, 360), m."""

    truth: np.ndarray
    odometry: np.ndarray
    scans: np.ndarray

    def run(self, slam: ParticleSlam) -> list[int]:
        """Which scans were used."""
        return [i for i in range(len(self.truth))
                if slam.add(i * PERIOD, self.odometry[i], self.scans[i], ANGLES, np.zeros(3))]


def walls() -> np.ndarray:
    """The world, uint8 (rows, columns) of CELL."""
    occupied = np.zeros((round(10 / CELL), round(16 / CELL)), np.uint8)
    for box in BOXES:
        left, low, right, high = np.round((np.array(box) - (ORIGIN * 2)) / CELL).astype(int)
        occupied[low:high, left:right] = 1
    return occupied


def drive(corners: tuple, step: float, seed: int, along: float = 0.05,
          turning: float = np.radians(3)) -> RecordedDrive:
    """Along the corners in steps of so many m; the odometry is off by so much a root metre."""
    random = np.random.default_rng(seed)
    truth = _path(np.array(corners, float), step)
    steps = poses.relative(truth[:-1], truth[1:])
    root = np.sqrt(np.hypot(steps[:, 0], steps[:, 1]))[:, None]
    turns = np.abs(steps[:, 2:]) * 0.02
    noise = random.normal(size=steps.shape)
    steps += noise * (root * (along, 0.3 * along, turning) + turns * (0, 0, 1))
    odometry = [truth[0]]
    for one in steps:
        odometry.append(poses.compose(odometry[-1], one))
    occupied = walls()
    scans = np.array([rays.cast(occupied, CELL, *ORIGIN, x, y, yaw + ANGLES, RANGE_MAX)
                      for x, y, yaw in truth])
    return RecordedDrive(truth, np.array(odometry), scans + random.normal(0, 0.01, scans.shape))


def trajectory_error(found: np.ndarray, truth: np.ndarray) -> float:
    """RMS distance, m, of positions (N, 2 or 3) after the best turn and shift."""
    a, b = (path[:, :2] - path[:, :2].mean(axis=0) for path in (found, truth))
    turn = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turned = poses.transform_points(np.array([0.0, 0.0, turn]), a)
    return float(np.sqrt(((turned - b) ** 2).sum(axis=1).mean()))


def _path(corners: np.ndarray, step: float) -> np.ndarray:
    found, yaw = [], 0.0
    for start, end in pairwise(corners):
        way = end - start
        turn = poses.wrap_angle(np.arctan2(way[1], way[0]) - yaw)
        for part in np.linspace(0, 1, 1 + int(np.ceil(abs(turn) / 0.1)))[1:]:
            found.append((*start, yaw + part * turn))
        yaw += turn
        for part in np.linspace(0, 1, 1 + int(np.ceil(np.hypot(*way) / step)))[1:]:
            found.append((*(start + part * way), yaw))
    return np.array([(1.0 * x, 1.0 * y, poses.wrap_angle(a)) for x, y, a in found])

"""A flat of four unlike rooms, a robot that wanders through it, and what its laser sees."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from nav_algorithms import likelihood_field, poses, rays
from nav_algorithms.cells import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from nav_algorithms.monte_carlo import Localisation
from nav_algorithms.sensor_models import Scan

CELL = 0.05                   # m
ANGLES = np.arange(360) * 2 * np.pi / 360
LASER = np.array([-0.06, 0.0, 0.0])
RANGE_MAX, PERIOD = 3.5, 0.2  # m, s
# (x0, y0, x1, y1), m: outer walls, walls between the rooms with doors in them, furniture.
BOXES = ((0, 0, 8, 0.15), (0, 5.85, 8, 6), (0, 0, 0.15, 6), (7.85, 0, 8, 6),
         (3.0, 0, 3.15, 1.2), (3.0, 2.2, 3.15, 6), (3.0, 3.0, 5.2, 3.15), (6.2, 3.0, 8, 3.15),
         (0, 3.6, 1.5, 3.75), (2.4, 3.6, 3, 3.75),
         (0.4, 0.4, 1.2, 1.5), (6.9, 0.4, 7.6, 1.9), (4.0, 5.2, 5.8, 5.7), (0.5, 5.0, 0.9, 5.6),
         (7.0, 4.2, 7.5, 4.6), (4.3, 1.2, 4.6, 1.5))


def robust(kind: type) -> dict[str, Any]:
    """What amcl/config/robust.yaml says of the fields of a settings class."""
    file = Path(__file__).parents[2] / "amcl" / "config" / "robust.yaml"
    values = yaml.safe_load(file.read_text(encoding="utf-8"))
    return {field.name: values[field.name] for field in fields(kind) if field.name in values}


def flat() -> OccupancyGrid:
    """The map, and the world itself."""
    cells = np.full((120, 160), FREE, np.int8)
    for box in BOXES:
        left, low, right, high = np.round(np.array(box) / CELL).astype(int)
        cells[low:high, left:right] = OCCUPIED
    return OccupancyGrid(cells, CELL, (0.0, 0.0))


def room(margin: int = 10) -> OccupancyGrid:
    """A room so many cells from the edge of 5 m x 4 m; nothing is known beyond its walls."""
    cells = np.full((80, 100), UNKNOWN, np.int8)
    wall, inside = margin - 1, margin
    cells[wall:-wall, wall:-wall] = OCCUPIED
    cells[inside:-inside, inside:-inside] = FREE
    return OccupancyGrid(cells, CELL, (0.0, 0.0))


def ring() -> OccupancyGrid:
    """A way round a block: each place has a twin that looks the same."""
    cells = np.pad(np.full((96, 156), FREE, np.int8), 2, constant_values=OCCUPIED)
    cells[25:75, 25:135] = OCCUPIED
    return OccupancyGrid(cells, CELL, (0.0, 0.0))


class Robot:
    """Drives straight on until something is near, then turns by chance; odometry is off by 2 %."""

    def __init__(self, seed: int, place: OccupancyGrid | None = None) -> None:
        """Stands somewhere in the place, or in the flat."""
        self.random = np.random.default_rng(seed)
        place = place or flat()
        self._occupied = (place.cells == OCCUPIED).astype(np.uint8)
        self._roomy = ((likelihood_field.distances(self._occupied) * CELL > 0.25)
                       & (place.cells == FREE))
        self._turns = 0
        self.crowd = 0.0  # share of the beams, from straight ahead on, that meet persons
        self.odometry = np.zeros(3)
        self.kidnap()

    def kidnap(self) -> None:
        """Puts it somewhere else; the odometry knows nothing of it."""
        row, column = self.random.choice(np.argwhere(self._roomy))
        self.pose = np.array([(column + 0.5) * CELL, (row + 0.5) * CELL,
                              self.random.uniform(-np.pi, np.pi)])

    def drive(self) -> None:
        """For one period between scans."""
        ahead = poses.compose(self.pose, (0.044, self.random.normal(0, 0.002), 0.0))
        column, row = (ahead[:2] / CELL).astype(int)
        if self._turns == 0 and not self._roomy[row, column]:
            self._turns = self.random.integers(4, 16)
        step = np.array([0.044, 0.0, 0.0])
        if self._turns:
            self._turns -= 1
            step = np.array([0.0, 0.0, 0.16])
        self.pose = poses.compose(self.pose, step)
        self.odometry = poses.compose(self.odometry,
                                      step * self.random.normal(1.0, 0.02, 3))

    def scan(self) -> Scan:
        """With 1 cm of noise, and one beam in fifty that sees nothing."""
        x, y, yaw = poses.compose(self.pose, LASER)
        ranges = rays.cast(self._occupied, CELL, 0.0, 0.0, x, y, yaw + ANGLES, RANGE_MAX)
        ranges += self.random.normal(0, 0.01, ranges.size)
        ranges[self.random.random(ranges.size) < 0.02] = np.inf
        crowded = np.arange(round(self.crowd * ranges.size))
        ranges[crowded] = np.minimum(ranges[crowded], 0.4 + 0.2 * np.sin(crowded / 8))
        return Scan(ranges, ANGLES, LASER, RANGE_MAX)

    def follow(self, localisation: Localisation, seconds: float) -> np.ndarray:
        """Drives for so long; how far off the estimate was at each scan, (N, 2), m and rad."""
        errors = []
        for _ in range(round(seconds / PERIOD)):
            self.drive()
            localisation.add(self.odometry, self.scan())
            off = poses.relative(self.pose,
                                 poses.compose(localisation.map_to_odom, self.odometry))
            errors.append((np.hypot(off[0], off[1]), abs(off[2])))
        return np.array(errors)

"""Lesson 5: the tunnel has no lines; follow the wall on the right by laser to the exit."""

from __future__ import annotations

import math

import numpy as np

from learning_autorace.calibration import Calibration
from learning_autorace.lane import WHITE, YELLOW, find_line

WALL = 0.21  # m, wanted distance on the right
FRONT = 0.34  # m: turn left if less is free ahead
SPEED, TURN = 0.12, 0.8  # m/s, rad/s
KP, KD = 5.0, 1.5  # rad/s per m of distance, and per rad of heading to the wall
BEFORE = 4  # images without a lane before it counts as a tunnel
EXIT = 3  # images with both lines before it is over


def distance(points: np.ndarray, towards: float, width: float = 0.35) -> float:
    """The least distance, m, in a sector of `width` rad around a direction, rad to the left."""
    if not len(points):
        return math.inf
    angles = np.arctan2(points[:, 1], points[:, 0]) - towards
    near = np.abs(np.arctan2(np.sin(angles), np.cos(angles))) < width / 2
    return float(np.hypot(*points[near].T).min(initial=math.inf))


def along_wall(points: np.ndarray) -> tuple[float, float]:
    """Speed in m/s and turn rate in rad/s that keep the wall at WALL on the right."""
    ahead = points[(points[:, 0] > 0) & (np.abs(points[:, 1]) < 0.12), 0].min(initial=math.inf)
    if ahead < FRONT:
        return 0.0 if ahead < 0.2 else SPEED / 2, TURN
    side, before = distance(points, -math.pi / 2), distance(points, -math.pi / 4, 0.2)
    if not math.isfinite(side):
        return SPEED, 0.0
    heading = min(before, 1.0) * math.cos(math.pi / 4) - side  # > 0: away from the wall
    turn = KP * (WALL - side) - KD * heading * 2
    return SPEED, max(-TURN, min(TURN, turn))


class Tunnel:
    """From where the lane ends to where it starts again."""

    name = "tunnel"

    def __init__(self, calibration: Calibration):
        self._calibration = calibration
        self._inside, self._count = False, 0
        self.done = False

    def step(self, seen) -> tuple[float, float] | None:
        """Follow the wall, or None: keep the lane."""
        half = self._calibration.lane_width / 2
        lines = [find_line(seen.view, colour, side * half, self._calibration) is not None
                 for colour, side in ((YELLOW, 1), (WHITE, -1))]
        wall = distance(seen.points, -math.pi / 2) < 2 * WALL
        turned = all(lines) if self._inside else (not any(lines) and wall)
        self._count = self._count + 1 if turned else 0
        if self._count > (EXIT if self._inside else BEFORE):
            self._inside, self.done, self._count = not self._inside, self._inside, 0
        return along_wall(seen.points) if self._inside else None

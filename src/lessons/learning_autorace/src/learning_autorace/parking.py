"""Lesson 6: drive into the car park, find the free bay by laser, park, and return to the lane."""

from __future__ import annotations

import math

import cv2
import numpy as np

from learning_autorace.calibration import Calibration
from learning_autorace.lane import WHITE

BESIDE = 0.19, 0.36  # m to the left: where the broken lines of the entrance are seen
APART = 0.25  # m between those lines
IN = 0.947  # m from the lane's middle to the bays' centres
SIDEWAYS = 0.275  # m from the entrance's middle to a bay's centre
BAY = 0.16  # m, half a bay
LOOK, PARKED = 0.5, 1.5  # s
SPEED, TURN = 0.12, 0.7  # m/s, rad/s
NEAR_PLACE, NEAR_ANGLE = 0.008, 0.02  # m, rad


def way_in(view: np.ndarray, calibration: Calibration) -> float | None:
    """How far ahead of the base the middle of the car park's entrance is, m; None: not seen."""
    columns = [round((calibration.half_width - y) * calibration.px_per_m) for y in BESIDE[::-1]]
    hsv = cv2.cvtColor(view[:, columns[0]:columns[1]], cv2.COLOR_BGR2HSV)
    there = cv2.inRange(hsv, *map(np.array, WHITE)).mean(axis=1) > 50
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(int)))
    lines = calibration.far - edges.reshape(-1, 2).mean(axis=1) / calibration.px_per_m
    return next(((far + near) / 2 for far in lines for near in lines
                 if abs(far - near - APART) < 0.03), None)


def free_side(points: np.ndarray) -> int:
    """1: the left bay is free, -1: the right one; the robot is between them."""
    inside = np.abs(points[:, 0]) < BAY
    left = np.sum(inside & (np.abs(points[:, 1] - SIDEWAYS) < BAY))
    right = np.sum(inside & (np.abs(points[:, 1] + SIDEWAYS) < BAY))
    return 1 if left < right else -1


class Parking:
    """A list of moves (turn to a heading, drive a distance, wait), done one by one by odometry."""

    name = "parking"

    def __init__(self, calibration: Calibration):
        self._calibration = calibration
        self._moves: list[tuple[str, float]] | None = None  # None: the entrance was not seen yet
        self._from: tuple[float, ...] | None = None  # s, x, y at the start of the move
        self.done = False

    def step(self, seen) -> tuple[float, float] | None:
        """The current move's command, or None: keep the lane."""
        if self._moves is None:
            ahead = way_in(seen.view, self._calibration)
            if ahead is None:
                return None
            self._heading = seen.pose[2]  # the lane was straight so far
            self._into = self._heading + math.pi / 2
            self._moves = [("go", ahead), ("turn", self._into), ("go", IN), ("look", LOOK)]
        if not self._moves:
            self.done = True
            return None
        kind, value = self._moves[0]
        self._from = self._from or (seen.time, *seen.pose[:2])
        command = getattr(self, f"_{kind}")(seen, value)
        if command is None:
            self._moves, self._from = self._moves[1:], None
        return command or (0.0, 0.0)

    def _turn(self, seen, heading: float) -> tuple[float, float] | None:
        self._heading, left = heading, math.remainder(heading - seen.pose[2], math.tau)
        return None if abs(left) < NEAR_ANGLE else (0.0, max(-TURN, min(TURN, 2.0 * left)))

    def _go(self, seen, way: float) -> tuple[float, float] | None:
        """Drive along the heading of the last turn, backwards if `way` is negative."""
        heading = self._heading
        x, y = seen.pose[0] - self._from[1], seen.pose[1] - self._from[2]
        cos, sin = math.cos(heading), math.sin(heading)
        left, aside = way - (cos * x + sin * y), cos * y - sin * x
        speed = max(-SPEED, min(SPEED, 1.5 * left))
        turn = 2.0 * math.remainder(heading - seen.pose[2], math.tau)
        turn -= 4.0 * aside * math.copysign(1, speed)
        return None if abs(left) < NEAR_PLACE else (speed, max(-TURN, min(TURN, turn)))

    def _wait(self, seen, seconds: float) -> tuple[float, float] | None:
        return (0.0, 0.0) if seen.time < self._from[0] + seconds else None

    def _look(self, seen, seconds: float) -> tuple[float, float] | None:
        """Wait for a scan from here, then add the moves into the free bay and back out."""
        waits = self._wait(seen, seconds)
        if not waits:
            side = free_side(seen.points) * math.pi / 2
            self._moves += [("turn", self._into + side), ("go", SIDEWAYS), ("wait", PARKED),
                            ("go", -SIDEWAYS), ("turn", self._into), ("go", -IN),
                            ("turn", self._into - math.pi / 2)]
        return waits

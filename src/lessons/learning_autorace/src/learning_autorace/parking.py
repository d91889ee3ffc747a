"""Lesson 6: turn off to the car park, find the free bay by laser, in, out, and back to the lane."""

from __future__ import annotations

import math

import cv2
import numpy as np

from learning_autorace.calibration import Calibration
from learning_autorace.lane import WHITE

BESIDE = 0.19, 0.36  # m to the left: where the broken lines of the way in are seen
APART = 0.25  # m, between those lines
IN = 0.947  # m from the lane's middle to the bays' middle
SIDEWAYS = 0.275  # m from the way's middle to a bay's middle
BAY = 0.16  # m, half a bay
PARKED = 1.5  # s
SPEED, TURN = 0.12, 0.7  # m/s, rad/s
NEAR_PLACE, NEAR_ANGLE = 0.008, 0.02  # m, rad


def broken_lines(view: np.ndarray, calibration: Calibration) -> list[float]:
    """How far ahead of the base, m, white lines lead to the left; near ones first."""
    columns = [round((calibration.half_width - y) * calibration.px_per_m) for y in BESIDE[::-1]]
    hsv = cv2.cvtColor(view[:, columns[0]:columns[1]], cv2.COLOR_BGR2HSV)
    there = cv2.inRange(hsv, *map(np.array, WHITE)).mean(axis=1) > 50
    edges = np.flatnonzero(np.diff(np.concatenate(([False], there, [False])).astype(int)))
    middles = edges.reshape(-1, 2).mean(axis=1)
    return sorted(calibration.far - row / calibration.px_per_m for row in middles)


def way_in(view: np.ndarray, calibration: Calibration) -> float | None:
    """How far ahead of the base the middle of the way into the car park is, m; None: not seen."""
    lines = broken_lines(view, calibration)
    for near in lines:
        for far in lines:
            if abs(far - near - APART) < 0.03:
                return (near + far) / 2
    return None


def free_side(points: np.ndarray) -> int:
    """1: the left bay is free, -1: the right one; the robot stands between them."""
    inside = np.abs(points[:, 0]) < BAY
    left = np.sum(inside & (np.abs(points[:, 1] - SIDEWAYS) < BAY))
    right = np.sum(inside & (np.abs(points[:, 1] + SIDEWAYS) < BAY))
    return 1 if left < right else -1


class Parking:
    """A list of moves (turn to a heading, go so far, wait), done one by one by odometry."""

    name = "parking"

    def __init__(self, calibration: Calibration):
        self._calibration = calibration
        self._moves: list[tuple[str, float]] = []
        self._target: float | None = None
        self._from = (0.0, 0.0)
        self._started = self.done = False

    def step(self, seen) -> tuple[float, float] | None:
        """The move that is under way, or None: keep the lane."""
        if self.done:
            return None
        if not self._started:
            ahead = way_in(seen.view, self._calibration)
            if ahead is None:
                return None
            self._started, quarter = True, math.pi / 2
            lane = round(seen.pose[2] / quarter) * quarter  # lanes lead along the axes here
            self._lane = lane
            self._moves = [("go", ahead), ("turn", lane + quarter), ("go", IN), ("look", 0.5)]
        if not self._moves:
            self.done = True
            return None
        kind, value = self._moves[0]
        command = getattr(self, f"_{kind}")(seen, value)
        if command is None:
            self._moves.pop(0)
            self._target = None
            return 0.0, 0.0
        return command

    def _turn(self, seen, heading: float) -> tuple[float, float] | None:
        left = math.remainder(heading - seen.pose[2], math.tau)
        if abs(left) < NEAR_ANGLE:
            return None
        return 0.0, max(-TURN, min(TURN, 2.0 * left))

    def _go(self, seen, way: float) -> tuple[float, float] | None:
        if self._target is None:
            self._from, self._heading = seen.pose[:2], self._straight(seen.pose[2])
            self._target = way
        x, y = seen.pose[0] - self._from[0], seen.pose[1] - self._from[1]
        cos, sin = math.cos(self._heading), math.sin(self._heading)
        left, aside = way - (cos * x + sin * y), cos * y - sin * x
        if abs(left) < NEAR_PLACE:
            return None
        speed = max(-SPEED, min(SPEED, 1.5 * left))
        turn = 2.0 * math.remainder(self._heading - seen.pose[2], math.tau)
        turn -= 4.0 * aside * math.copysign(1, speed)
        return speed, max(-TURN, min(TURN, turn))

    def _straight(self, yaw: float) -> float:
        return round(yaw / (math.pi / 2)) * math.pi / 2

    def _wait(self, seen, seconds: float) -> tuple[float, float] | None:
        self._target = seen.time if self._target is None else self._target
        return (0.0, 0.0) if seen.time < self._target + seconds else None

    def _look(self, seen, seconds: float) -> tuple[float, float] | None:
        """Wait for a scan from here, then add the moves into the free bay and out again."""
        if self._wait(seen, seconds):
            return 0.0, 0.0
        into = self._lane + math.pi / 2
        side = free_side(seen.points)
        self._moves += [("turn", into + side * math.pi / 2), ("go", SIDEWAYS), ("wait", PARKED),
                        ("go", -SIDEWAYS), ("turn", into), ("go", -IN), ("turn", self._lane)]
        return None

"""The rules by which turtlebot3_drive keeps clear of walls; three laser rays and a heading."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

CENTRE_RAY, LEFT_RAY, RIGHT_RAY = 0, 30, 330  # index of a 360-ray scan, one degree each
CLEAR_AHEAD = 0.7  # m
CLEAR_ASIDE = 0.6  # m
TURN = math.radians(30)
SPEED = 0.3  # m/s
TURN_RATE = 1.5  # rad/s

Command = tuple[float, float]  # m/s forward, rad/s to the left


@dataclass(frozen=True)
class Rays:
    """Distances in m."""

    centre: float
    left: float
    right: float


def rays(ranges: Sequence[float], range_max: float) -> Rays:
    """The three rays of a scan; nothing hit counts as the farthest, too near to measure as 0 m."""
    return Rays(*(distance(ranges[i], range_max) for i in (CENTRE_RAY, LEFT_RAY, RIGHT_RAY)))


def distance(measured: float, range_max: float) -> float:
    if math.isfinite(measured):
        return measured
    return 0.0 if measured < 0 else range_max


def turned(start: float, now: float) -> float:
    """How far the heading has come since, in rad, the shorter way round: -pi and pi are one."""
    return abs(math.remainder(now - start, math.tau))


def look(seen: Rays) -> Command:
    """Where to go: forward where it is clear, else a turn away from what is near."""
    if seen.centre < CLEAR_AHEAD or seen.left < CLEAR_ASIDE:
        return 0.0, -TURN_RATE
    if seen.right < CLEAR_ASIDE:
        return 0.0, TURN_RATE
    return SPEED, 0.0


class Wanderer:
    """Looks, and then either goes on for one step or turns by 30 degrees."""

    def __init__(self) -> None:
        self._turn_from: float | None = None  # rad, heading when the turn began
        self._turn: Command = (0.0, 0.0)

    def update(self, seen: Rays, heading: float) -> Command:
        if self._turn_from is not None and turned(self._turn_from, heading) < TURN:
            return self._turn
        command = look(seen)
        self._turn_from = heading if command[1] else None
        self._turn = command
        return command

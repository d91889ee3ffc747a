"""The law that drives a turtle round a square again and again, to exact corners."""

from __future__ import annotations

import math
from dataclasses import dataclass

SIDE = 2.0  # m
SPEED = 1.0  # m/s
TURN_RATE = 0.4  # rad/s
# Upstream is content within 0.1 m and 0.01 rad and goes on from there, so its squares drift. Here
# the turtle slows down before each goal, and the corners follow from where it began.
NEAR = 0.002  # m
STRAIGHT = 0.0005  # rad
SLOWING = 8.0  # 1/s: speed for what is left
STOPPED = 1e-4  # m/s and rad/s


@dataclass(frozen=True)
class Goal:
    """m and rad; driving looks at the place only, turning at theta only."""

    x: float
    y: float
    theta: float


class SquareDriver:
    """Begins with a side straight ahead of this pose. `goal` is what it drives to at present."""

    def __init__(self, x: float, y: float, theta: float) -> None:
        self._heading = theta  # rad, of the side, were it exact
        self._corner = _ahead((x, y), theta)  # the side's end
        self._turning = False
        self.goal = Goal(*self._corner, theta)

    def update(self, x: float, y: float, theta: float, moving: bool) -> tuple[float, float]:
        """(m/s, rad/s) for a turtle at this pose; `goal` changes when it stands at the old one."""
        if self._turning:
            command = 0.0, _approach(wrap(self.goal.theta - theta), TURN_RATE, STRAIGHT)
        else:
            left = math.cos(theta) * (self.goal.x - x) + math.sin(theta) * (self.goal.y - y)
            command = _approach(left, SPEED, NEAR), 0.0
        if command == (0.0, 0.0) and not moving:
            self._next_goal(x, y)
        return command

    def _next_goal(self, x: float, y: float) -> None:
        self._turning = not self._turning
        if not self._turning:
            self.goal = Goal(*self._corner, self.goal.theta)
            return
        self._heading = wrap(self._heading + math.pi / 2)
        self._corner = _ahead(self._corner, self._heading)
        # From where the turtle is: what it is beside its corner must not add up.
        self.goal = Goal(x, y, math.atan2(self._corner[1] - y, self._corner[0] - x))


def wrap(angle: float) -> float:
    """The same direction in [-pi, pi)."""
    return (angle + math.pi) % (2 * math.pi) - math.pi


def _ahead(corner: tuple[float, float], heading: float) -> tuple[float, float]:
    return corner[0] + SIDE * math.cos(heading), corner[1] + SIDE * math.sin(heading)


def _approach(left: float, fastest: float, near: float) -> float:
    return min(max(SLOWING * left, -fastest), fastest) if abs(left) > near else 0.0

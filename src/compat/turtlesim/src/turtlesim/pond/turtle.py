"""One turtle: where it is, how it moves in a tick, what it draws; upstream's rules and numbers."""

from __future__ import annotations

import math
from collections.abc import Callable

from turtlesim.pond.canvas import SIDE, Canvas, Color, Pen, Place

TICK = 0.016  # s of motion in each step, however long the step took
COMMAND_LIFE = 1.0  # s
THINNEST_PX = 1  # what width 0 asks for


class Turtle:
    """x, y in m from the bottom left corner, theta in rad counter-clockwise from x.

    `now` is in seconds of any clock that only goes forward.
    """

    def __init__(self, x: float, y: float, theta: float, look: int) -> None:
        self.x, self.y, self.theta = x, y, theta
        self.look = look
        self.pen = Pen()
        self.color: Color = (0, 0, 0)  # under its centre, at the last step
        self.forward = self.sideways = self.turn_rate = 0.0  # m/s, m/s, rad/s
        self._commanded = -math.inf
        self._jumps: list[Callable[[], None]] = []

    @property
    def place(self) -> Place:
        return self.x, self.y

    @property
    def speed(self) -> float:
        """m/s, never negative."""
        return math.hypot(self.forward, self.sideways)

    def command(self, forward: float, sideways: float, turn_rate: float, now: float) -> None:
        """Speeds in m/s, m/s (to the left) and rad/s, which hold for COMMAND_LIFE."""
        self.forward, self.sideways, self.turn_rate = forward, sideways, turn_rate
        self._commanded = now

    def set_pen(self, color: Color, width_px: int, off: bool) -> None:
        """Switching the pen off leaves its colour and width alone; width 0 is the thinnest."""
        if off:
            self.pen = Pen(self.pen.color, self.pen.width_px, on=False)
        else:
            self.pen = Pen(color, width_px or THINNEST_PX)

    def teleport_absolute(self, x: float, y: float, theta: float) -> None:
        """At the next step; above the top edge means on it."""
        self._jumps.append(lambda: self._put(x, min(y, SIDE), theta))

    def teleport_relative(self, linear: float, angular: float) -> None:
        """At the next step: turns by angular rad first, then moves linear m forward."""
        self._jumps.append(lambda: self._leap(linear, angular))

    def step(self, now: float, canvas: Canvas) -> Place | None:
        """One tick. The place outside the pond that it was put back from, if it hit the wall."""
        for jump in self._jumps:
            start = self.place
            jump()
            canvas.line(start, self.place, self.pen)
        self._jumps.clear()
        if now - self._commanded > COMMAND_LIFE:
            self.forward = self.sideways = self.turn_rate = 0.0
        start = self.place
        self._move()
        wanted = self.place
        self.x, self.y = (min(max(value, 0.0), SIDE) for value in wanted)
        self.color = canvas.color_at(self.place)  # before this step's own line is there
        if self.place != start:
            canvas.line(start, self.place, self.pen)
        return wanted if self.place != wanted else None

    def _put(self, x: float, y: float, theta: float) -> None:
        self.x, self.y, self.theta = x, y, theta

    def _leap(self, linear: float, angular: float) -> None:
        self.theta += angular
        self.x += math.cos(self.theta) * linear
        self.y += math.sin(self.theta) * linear

    def _move(self) -> None:
        """Turns first: the step goes in the new direction."""
        turned = self.theta + self.turn_rate * TICK
        self.theta = (turned + math.pi) % (2 * math.pi) - math.pi
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        ahead, left = self.forward * TICK, self.sideways * TICK
        self.x += cosine * ahead - sine * left
        self.y += sine * ahead + cosine * left

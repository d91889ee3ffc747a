"""The pond: its turtles by name, what they have drawn, and the picture of it all.

A turtle moves and draws by upstream's rules and numbers.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import numpy as np

from turtlesim.pond.canvas import LOOKS, SIDE, Canvas, Color, Pen, Place, draw_turtle

TICK = 0.016  # s of motion in each step, however long the step took
COMMAND_LIFE = 1.0  # s
THINNEST_PX = 1  # what width 0 asks for
BACKGROUND: Color = (69, 86, 255)
FIRST = "turtle1"


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


class PondError(Exception):
    """What was asked for cannot be done; the message is upstream's."""


class Pond:
    """Begins with turtle1 in the middle. Each turtle's look is drawn from `rng`."""

    def __init__(self, rng: random.Random, background: Color = BACKGROUND) -> None:
        self._rng = rng
        self.turtles: dict[str, Turtle] = {}
        self.canvas = Canvas(background)
        self._scene: tuple | None = None
        self._picture = self.canvas.pixels
        self.reset(background)

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """A new turtle; without a name it is turtleN with the next free N. Returns the name."""
        while not name:
            self._count += 1
            candidate = f"turtle{self._count}"
            name = "" if candidate in self.turtles else candidate
        if name in self.turtles:
            raise PondError(f"A turtle named [{name}] already exists")
        self.turtles[name] = Turtle(x, y, theta, self._rng.randrange(len(LOOKS)))
        return name

    def kill(self, name: str) -> None:
        """Its lines stay."""
        if name not in self.turtles:
            raise PondError(f"Tried to kill turtle [{name}], which does not exist")
        del self.turtles[name]

    def clear(self, background: Color) -> None:
        self.canvas.fill(background)

    def reset(self, background: Color) -> None:
        """As at the beginning."""
        self.turtles.clear()
        self._count = 0
        self.spawn("", SIDE / 2, SIDE / 2, 0.0)
        self.clear(background)

    def step(self, now: float) -> list[Place]:
        """One tick of every turtle, in order of their names.

        Returns the places outside the pond from which turtles were put back.
        """
        steps = [turtle.step(now, self.canvas) for turtle in self._in_order()]
        return [place for place in steps if place is not None]

    def picture(self) -> np.ndarray:
        """(500, 500, 3) uint8 RGB: the lines, and the turtles upon them.

        The same array until something looks different; a new one then. Not to be written to.
        """
        turtles = [(turtle.place, turtle.theta, turtle.look) for turtle in self._in_order()]
        scene = self.canvas.changes, turtles
        if scene != self._scene:
            self._scene, self._picture = scene, self.canvas.pixels.copy()
            for turtle in turtles:
                draw_turtle(self._picture, *turtle)
        return self._picture

    def _in_order(self) -> list[Turtle]:
        return [self.turtles[name] for name in sorted(self.turtles)]

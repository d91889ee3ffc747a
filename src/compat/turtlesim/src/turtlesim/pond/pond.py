"""The pond: its turtles by name, what they have drawn, and the picture of it all."""

from __future__ import annotations

import random

import numpy as np

from turtlesim.pond.canvas import SIDE, Canvas, Color, Place
from turtlesim.pond.looks import LOOKS, draw_turtle
from turtlesim.pond.turtle import Turtle

BACKGROUND: Color = (69, 86, 255)
FIRST = "turtle1"


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

"""Lanes on the floor: a polygon with rounded corners, a yellow line left, a white one right."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from turtlebot3_gazebo.making.painting import WHITE, YELLOW, Canvas, Point

STEP = 0.02  # m, between the points of a bend


@dataclass(frozen=True)
class Painter:
    """Paints in world coordinates (m) on a plane that the world turns by `yaw`."""

    canvas: Canvas
    yaw: float
    line_width: float

    def line(self, points: Sequence[Point], colour, width: float | None = None) -> None:
        self.canvas.stroke([self._on_plane(p) for p in points], width or self.line_width, colour)

    def area(self, corners: Sequence[Point], colour) -> None:
        self.canvas.fill([self._on_plane(p) for p in corners], colour)

    def dashes(self, start: Point, end: Point, colour, length: float = 0.06) -> None:
        """A straight broken line."""
        count = max(1, round(math.dist(start, end) / length / 2))
        for i in range(count):
            share = [(2 * i + j) / (2 * count) for j in (0, 1)]
            self.line([tuple(a + (b - a) * s for a, b in zip(start, end, strict=True))
                       for s in share], colour)

    def lane(self, corners: Sequence[Point], radius: float, width: float) -> None:
        """An open lane along the corners, driven in their order."""
        middle = rounded(corners, radius)
        self.line(beside(middle, width / 2), YELLOW)
        self.line(beside(middle, -width / 2), WHITE)

    def _on_plane(self, point: Point) -> Point:
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        return cos * point[0] + sin * point[1], cos * point[1] - sin * point[0]


def rounded(corners: Sequence[Point], radius: float) -> list[Point]:
    """The open polygon with its corners as arcs, sampled."""
    points = [corners[0]]
    for before, corner, after in zip(corners[:-2], corners[1:-1], corners[2:], strict=True):
        points += bend(before, corner, after, radius)
    return [*points, corners[-1]]


def bend(before: Point, corner: Point, after: Point, radius: float) -> list[Point]:
    """Points of the arc that touches both sides of a corner."""
    heading = math.atan2(corner[1] - before[1], corner[0] - before[0])
    leaving = math.atan2(after[1] - corner[1], after[0] - corner[0])
    turn = math.remainder(leaving - heading, math.tau)
    cut = radius * math.tan(abs(turn) / 2)
    x, y = corner[0] - cut * math.cos(heading), corner[1] - cut * math.sin(heading)
    side = math.copysign(radius, turn)
    centre = x - side * math.sin(heading), y + side * math.cos(heading)
    count = max(2, math.ceil(abs(turn) * radius / STEP))
    angles = [heading + turn * i / count for i in range(count + 1)]
    return [(centre[0] + side * math.sin(a), centre[1] - side * math.cos(a)) for a in angles]


def beside(points: Sequence[Point], left: float) -> list[Point]:
    """The same way, so many metres to the left (negative: to the right)."""
    moved = []
    for i, point in enumerate(points):
        before, after = points[max(i - 1, 0)], points[min(i + 1, len(points) - 1)]
        length = math.dist(before, after)
        moved.append((point[0] - left * (after[1] - before[1]) / length,
                      point[1] + left * (after[0] - before[0]) / length))
    return moved

"""Pictures from lines and areas with smooth edges, their PNG files, and lanes on the floor.

Coordinates: x to the right, y up, origin in the picture's middle, in a unit of the caller's own. A
lane is a polygon with rounded corners, with a yellow line left and a white one right.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from racecar_description.track.course_model import encode_png

Point = tuple[float, float]
Colour = tuple[int, int, int]  # RGB
BLACK, WHITE, YELLOW, RED = (0, 0, 0), (255, 255, 255), (255, 255, 0), (255, 0, 0)
BLUE, GREEN = (0, 70, 170), (0, 150, 60)
STEP = 0.02  # m, between the points of a bend


class Canvas:
    """A square picture, (side_px, side_px, 3) uint8 RGB, showing `size` units each way."""

    def __init__(self, side_px: int, size: float, background: Colour):
        self.pixels = np.full((side_px, side_px, 3), background, np.uint8)
        self._unit_px = side_px / size
        self._centres = (np.arange(side_px) + 0.5) / self._unit_px - size / 2

    def stroke(self, points: Sequence[Point], width: float, colour: Colour) -> None:
        """A line through the points, with round ends; of one point alone a disc."""
        ends = list(points) if len(points) > 1 else [points[0], points[0]]
        for a, b in pairwise(ends):
            columns, rows, x, y = self._around([a, b], width / 2)
            self._lay(columns, rows, width / 2 - _distance(a, b, x, y), colour)

    def fill(self, corners: Sequence[Point], colour: Colour) -> None:
        """A polygon."""
        columns, rows, x, y = self._around(corners, 0.0)
        inside = np.zeros(np.broadcast(x, y).shape, bool)
        edge = np.full(inside.shape, np.inf)
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
            edge = np.minimum(edge, _distance(a, b, x, y))
            if a[1] != b[1]:
                beside = x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
                inside ^= ((y < a[1]) != (y < b[1])) & beside
        self._lay(columns, rows, np.where(inside, edge, -edge), colour)

    def png(self) -> bytes:
        """The picture's file."""
        return encode_png(self.pixels)

    def _around(self, points: Sequence[Point], reach: float):
        """Columns and rows (top first) that shapes so near to the points touch; their x and y."""
        (left, low), (right, high) = np.min(points, axis=0), np.max(points, axis=0)
        reach += 1 / self._unit_px
        columns = slice(*np.searchsorted(self._centres, (left - reach, right + reach)))
        rows = slice(*np.searchsorted(self._centres, (-high - reach, -low + reach)))
        return columns, rows, self._centres[columns][None, :], -self._centres[rows][:, None]

    def _lay(self, columns: slice, rows: slice, depth: np.ndarray, colour: Colour) -> None:
        """Mix the colour in, by how deep (units) each pixel's middle lies within the shape."""
        # Rounded first, so that no last digit of a sum can change a pixel.
        cover = np.floor(np.clip(np.round(depth * self._unit_px, 6) + 0.5, 0, 1) * 255 + 0.5)
        cover = cover[..., None] / 255
        below = self.pixels[rows, columns]
        mixed = below * (1 - cover) + np.array(colour, float) * cover
        self.pixels[rows, columns] = np.floor(mixed + 0.5).astype(np.uint8)


def _distance(a: Point, b: Point, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """From the straight line between two points."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    along = np.clip(((x - a[0]) * dx + (y - a[1]) * dy) / (length2 or 1.0), 0.0, 1.0)
    return np.sqrt((x - a[0] - along * dx) ** 2 + (y - a[1] - along * dy) ** 2)


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
    """The same way, `left` m to the left (negative: to the right)."""
    moved = []
    for i, point in enumerate(points):
        before, after = points[max(i - 1, 0)], points[min(i + 1, len(points) - 1)]
        length = math.dist(before, after)
        moved.append((point[0] - left * (after[1] - before[1]) / length,
                      point[1] + left * (after[0] - before[0]) / length))
    return moved

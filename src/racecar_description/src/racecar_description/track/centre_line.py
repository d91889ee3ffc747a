"""A closed centre line of straights and arcs: a polygon whose corners are rounded."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from node_basics.records import Must, is_number

from racecar_description.track.errors import TrackError

STRAIGHT = 1e-9  # rad and m: below this there is no bend, and no piece
LEAST_CURVATURE = 1e-12  # 1/m
MOST = 1e4  # m, of any number; on a line of millions of km a nearest-point search takes minutes
SPACING = 0.02  # m, between the points that represent the line in drawings and checks


def is_coordinate(value: object) -> bool:
    """Whether it is a number from -MOST to MOST."""
    return is_number(value, -MOST, MOST)


Coordinate = Annotated[float, Must(f"a number up to {MOST:g}", is_coordinate)]
Size = Annotated[float, Must(f"a number above 0 and up to {MOST:g}",
                             lambda value: is_coordinate(value) and value > 0)]


@dataclass(frozen=True)
class Corner:
    """One corner of the polygon that the line follows, rounded by an arc of this radius."""

    x: Coordinate
    y: Coordinate
    radius: Size


@dataclass(frozen=True)
class Piece:
    """A straight (curvature 0) or an arc (1/radius, left positive), starting at a pose."""

    x: float
    y: float
    heading: float
    length: float
    curvature: float

    @property
    def is_straight(self) -> bool:
        """Whether the curvature is too small for an arc's formulas."""
        return abs(self.curvature) < LEAST_CURVATURE

    def pose(self, s: float) -> tuple[float, float, float]:
        """x, y and heading after s metres on this piece."""
        turned = self.heading + self.curvature * s
        if self.is_straight:
            return self.x + s * math.cos(turned), self.y + s * math.sin(turned), turned
        x = self.x + (math.sin(turned) - math.sin(self.heading)) / self.curvature
        y = self.y - (math.cos(turned) - math.cos(self.heading)) / self.curvature
        return x, y, turned

    def nearest(self, x: float, y: float) -> float:
        """The length (m) along this piece at which it is closest to the point."""
        ahead = math.cos(self.heading) * (x - self.x) + math.sin(self.heading) * (y - self.y)
        if self.is_straight:
            return min(max(ahead, 0.0), self.length)
        left = -math.sin(self.heading) * (x - self.x) + math.cos(self.heading) * (y - self.y)
        side = math.copysign(1.0, self.curvature)
        radius = 1.0 / abs(self.curvature)
        angle = math.atan2(ahead, radius - side * left)
        whole = self.length / radius
        # The side without the arc is split in the middle: each half is nearer to one end.
        if angle < whole / 2 - math.pi:
            angle += 2 * math.pi
        return min(max(angle, 0.0), whole) * radius

    def offset(self, left: float) -> Piece:
        """The parallel piece this far (m) to the left; TrackError if a bend is too tight."""
        scale = 1.0 - self.curvature * left
        if scale <= 0:
            raise TrackError(
                f"no line {left:+.3f} m beside a bend of radius {1 / abs(self.curvature):.3f} m"
            )
        x = self.x - left * math.sin(self.heading)
        y = self.y + left * math.cos(self.heading)
        return Piece(x, y, self.heading, self.length * scale, self.curvature / scale)


class CentreLine:
    """A closed line with rounded corners, driven in their order; s (m) wraps at `length`."""

    def __init__(self, corners: Sequence[Corner]):
        self.corners = tuple(corners)
        self.pieces = _pieces(self.corners)
        ends = np.cumsum([piece.length for piece in self.pieces])
        self.length = float(ends[-1])
        self._begins = np.concatenate(([0.0], ends[:-1]))

    def pose(self, s: float) -> tuple[float, float, float]:
        """x, y (m) and heading (rad) at s."""
        s %= self.length
        i = int(np.searchsorted(self._begins, s, side="right")) - 1
        return self.pieces[i].pose(s - self._begins[i])

    def points(self, spacing: float = SPACING) -> np.ndarray:
        """(n, 2) evenly spaced points along the whole line, the first at s = 0."""
        count = max(8, math.ceil(self.length / spacing))
        return np.array([self.pose(i * self.length / count)[:2] for i in range(count)])

    def nearest(self, x: float, y: float) -> float:
        """s of the line's point closest to x, y."""
        found = [(begin, piece, piece.nearest(x, y))
                 for begin, piece in zip(self._begins, self.pieces, strict=True)]
        begin, _, s = min(found, key=lambda one: math.dist(one[1].pose(one[2])[:2], (x, y)))
        return float(begin + s) % self.length

    def tightest(self) -> tuple[float, float, float]:
        """Radius (m) of the sharpest bend, and its x, y."""
        bends = [piece for piece in self.pieces if piece.curvature]
        sharpest = max(bends, key=lambda piece: abs(piece.curvature))
        x, y, _ = sharpest.pose(sharpest.length / 2)
        return 1.0 / abs(sharpest.curvature), x, y

    def reversed(self) -> CentreLine:
        """The same line in the opposite direction."""
        return CentreLine(self.corners[::-1])

    def moved(self, dx: float, dy: float) -> CentreLine:
        """The line, translated; coordinates are rounded to a nanometre."""
        shifted = [Corner(round(c.x + dx, 9), round(c.y + dy, 9), c.radius) for c in self.corners]
        return CentreLine(shifted)


def _pieces(corners: tuple[Corner, ...]) -> tuple[Piece, ...]:
    """An arc for each corner and the straight after it, without pieces of zero length."""
    x, y, radius = np.array([(c.x, c.y, c.radius) for c in corners], float).T
    edge_x, edge_y = np.roll(x, -1) - x, np.roll(y, -1) - y
    edges, leaving = np.hypot(edge_x, edge_y), np.arctan2(edge_y, edge_x)
    arriving = np.roll(leaving, 1)
    turns = (leaving - arriving + math.pi) % (2 * math.pi) - math.pi
    cuts = radius * np.tan(np.abs(turns) / 2)
    pieces = []
    for i in range(len(corners)):
        j = (i + 1) % len(corners)
        straight = edges[i] - cuts[i] - cuts[j]
        if straight < -STRAIGHT or edges[i] < STRAIGHT:
            overlap = f"the bends overlap by {-straight:.3f} m; make a radius smaller"
            raise TrackError(f"corners[{i}] and [{j}]: {overlap}")
        if abs(turns[i]) > STRAIGHT:
            begin_x = x[i] - cuts[i] * math.cos(arriving[i])
            begin_y = y[i] - cuts[i] * math.sin(arriving[i])
            curvature = math.copysign(1.0 / radius[i], turns[i])
            length = abs(turns[i]) * radius[i]
            pieces.append(Piece(begin_x, begin_y, arriving[i], length, curvature))
        if straight > STRAIGHT:
            begin_x = x[i] + cuts[i] * math.cos(leaving[i])
            begin_y = y[i] + cuts[i] * math.sin(leaving[i])
            pieces.append(Piece(begin_x, begin_y, leaving[i], straight, 0.0))
    return tuple(pieces)

"""Random closed circuits: straights and arcs of a least radius, clear of each other.

All randomness is from `random.Random`, whose numbers are the same on all machines and versions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random

from racecar_description.track.centre_line import CentreLine, Corner
from racecar_description.track.clearance import touching_place
from racecar_description.track.errors import TrackError

TRIES, ENOUGH = 4000, 4  # polygons tried at most; good circuits of which the longest is chosen
MOST_CORNERS, LEAST_CORNERS = 9, 5
MARGIN = 0.3  # m, between the road and the plane's edge, room for a wall
STRAIGHT = 1.5  # m, least length of the edge at the bottom on which the car starts


@dataclass(frozen=True)
class Room:
    """The constraints on a circuit: the plane's sides, the road's width, the least radius; m."""

    width: float
    height: float
    road_width: float
    least_radius: float

    @property
    def inner(self) -> tuple[float, float]:
        """Sides of the rectangle that may contain the centre line."""
        border = self.road_width + 2 * MARGIN
        return self.width - border, self.height - border


def random_circuit(seed: int, room: Room) -> CentreLine:
    """The seed's circuit, counter-clockwise; the origin is the plane's lower left corner."""
    diameter = 2 * room.least_radius
    if min(room.inner) < diameter:
        least = math.ceil((diameter + room.road_width + 2 * MARGIN) * 10) / 10
        raise TrackError(
            f"no circuit with bends of {room.least_radius:g} m and a road of"
            f" {room.road_width:g} m fits; --size {least:g}x{least:g} at least"
        )
    random, found = Random(seed), []
    for number in range(TRIES):
        # Simpler and simpler, so that there is a circuit for small rooms too.
        corners = MOST_CORNERS - (MOST_CORNERS - LEAST_CORNERS + 1) * number // TRIES
        line = _circuit(random, room, corners)
        if line is not None:
            found.append(line)
        if len(found) == ENOUGH:
            break
    return max(found, key=lambda line: line.length) if found else _oval(room)


def _circuit(random: Random, room: Room, count: int) -> CentreLine | None:
    """A circuit with this many random corners, or None if there is none."""
    points = _points(random, room, count)
    order = _untangled(points)
    corners = _corners([points[i] for i in order], room)
    if corners is None:
        return None
    line = CentreLine(corners)
    return None if touching_place(line, room.road_width + MARGIN) else line


def _points(random: Random, room: Room, count: int) -> list[tuple[float, float]]:
    """Points in the inner rectangle; the first two have the same y, and a straight between."""
    width, height = room.inner
    left, low = room.road_width / 2 + MARGIN, room.road_width / 2 + MARGIN
    y = low + random.uniform(0, 0.15) * height
    needed = min(STRAIGHT + 2 * room.least_radius, width)
    begin = random.uniform(0, width - needed)
    end = random.uniform(begin + needed, width)
    points = [(left + begin, y), (left + end, y)]
    points += [
        (left + random.uniform(0, width), random.uniform(y, low + height)) for _ in range(count - 2)
    ]
    return [(round(x, 3), round(y, 3)) for x, y in points]


def _untangled(points: list[tuple[float, float]]) -> list[int]:
    """A closed tour without crossings that starts with the first two points (2-opt)."""
    apart = [[math.dist(one, other) for other in points] for one in points]
    order = list(range(len(points)))
    improved = True
    while improved:
        improved = False
        for i in range(1, len(order) - 1):
            for j in range(i + 1, len(order)):
                begin, following, end, after = (
                    order[i], order[i + 1], order[j], order[(j + 1) % len(order)])
                old = apart[begin][following] + apart[end][after]
                new = apart[begin][end] + apart[following][after]
                if new < old - 1e-9:
                    order[i + 1 : j + 1] = order[i + 1 : j + 1][::-1]
                    improved = True
    return order


def _corners(points: list[tuple[float, float]], room: Room) -> list[Corner] | None:
    """The polygon's corners with radii that fit its edges; None if one does not fit."""
    count = len(points)
    edges = [math.dist(points[i], points[(i + 1) % count]) for i in range(count)]
    headings = [
        math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(points, points[1:] + points[:1])
    ]
    turns = [math.remainder(headings[i] - headings[i - 1], 2 * math.pi) for i in range(count)]
    if min(edges) < 0.1 or max(map(abs, turns)) > 2.8 or sum(turns) < 6:
        return None
    slopes = [math.tan(abs(turn) / 2) for turn in turns]
    # Neighbours share their edge in proportion to what the least radius needs.
    radii = []
    for i in range(count):
        shares = [edges[i] / (slopes[i] + slopes[(i + 1) % count] + 1e-9)]
        shares += [edges[i - 1] / (slopes[i] + slopes[i - 1] + 1e-9)]
        radii.append(math.floor(min(*shares, 3 * room.least_radius) * 1000) / 1000)
    if min(radii) < room.least_radius:
        return None
    return [Corner(x, y, radius) for (x, y), radius in zip(points, radii, strict=True)]


def _oval(room: Room) -> CentreLine:
    """The fallback if nothing else fits."""
    width, height = room.inner
    left = low = room.road_width / 2 + MARGIN
    radius = math.floor(min(width, height) / 2 * 1000) / 1000
    right, top = left + width, low + height
    corners = [(left, low), (right, low), (right, top), (left, top)]
    return CentreLine([Corner(round(x, 3), round(y, 3), radius - 0.001) for x, y in corners])

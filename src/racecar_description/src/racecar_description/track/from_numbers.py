"""A course from a track file, or from a seed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from racecar_description.track.centre_line import CentreLine
from racecar_description.track.circuit import (
    CENTRE_LINE,
    LANE,
    Circuit,
    Plane,
    lane_width,
    road_width,
)
from racecar_description.track.errors import TrackError
from racecar_description.track.random_circuit import Room, random_circuit
from racecar_description.track.track_file import load_centre_line
from racecar_description.track.wishes import (
    DEFAULT_SIZE,
    RoadTouches,
    Wishes,
    check_start,
    clear_lane,
    plane_round,
)


def from_track_file(path: Path, wishes: Wishes) -> tuple[Circuit, list[str]]:
    """The course of a centre line, with its coordinates and, unless given, its widths."""
    track, line = load_centre_line(path)
    remarks: list[str] = []
    if wishes.backwards:
        line = line.reversed()
    lane = track.lane_width if wishes.width is None else lane_width(wishes.width)
    try:
        lane = clear_lane(line, lane, wishes, remarks)
    except RoadTouches as error:
        raise TrackError(f"{path}: {error}") from error
    start_s = line.nearest(*(wishes.start or track.start))
    check_start(wishes, line.pose(start_s)[:2], lane)
    points = line.points()
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    course = Circuit(
        name=wishes.name,
        source=path.name,
        line=line,
        start_s=start_s,
        line_width=track.line_width,
        lane_width=lane,
        plane=plane_round(line, lane, np.array(wishes.size or (0.0, 0.0)), middle),
        walls=wishes.walls,
    )
    return course, remarks


def from_seed(seed: int, wishes: Wishes) -> tuple[Circuit, list[str]]:
    """The seed's random circuit on a plane of the wanted size."""
    width, height = wishes.size or DEFAULT_SIZE
    lane = LANE if wishes.width is None else lane_width(wishes.width)
    line = random_circuit(seed, Room(width, height, road_width(lane), wishes.least_radius))
    if wishes.backwards:
        line = line.reversed()
    x, y = _start(line) if wishes.start is None else line.pose(line.nearest(*wishes.start))[:2]
    check_start(wishes, (x, y), lane)
    line = line.moved(-x, -y)
    course = Circuit(
        name=wishes.name,
        source=f"seed {seed}",
        line=line,
        start_s=line.nearest(0.0, 0.0),
        line_width=CENTRE_LINE,
        lane_width=lane,
        plane=Plane(round(width / 2 - x, 6), round(height / 2 - y, 6), width, height),
        walls=wishes.walls,
        origin=(x, y),
    )
    return course, []


def _start(line: CentreLine) -> tuple[float, float]:
    """About the middle of the longest straight, preferably along x."""
    straights = [piece for piece in line.pieces if piece.curvature == 0.0]
    along_x = [piece for piece in straights if abs(math.sin(piece.heading)) < 1e-6]
    longest = max(along_x or straights or line.pieces, key=lambda piece: piece.length)
    x, y, _ = longest.pose(longest.length / 2)
    return (round(x, 3), round(y, 3)) if along_x else (x, y)

"""A race course, ready to be drawn: the line, its road, and the plane it is painted on.

World frame, m. Courses from drawings and seeds have the world's origin where a lap starts, so that
a car put at 0, 0 stands on the line; a track file's coordinates are the world's already.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from racecar_description.track.centre_line import CentreLine
from racecar_description.track.track_file import TrackFile

EDGE_LINE = 0.03  # m, width of the white lines at the road's edges
VERGE = 0.03  # m of asphalt outside them
CENTRE_LINE = 0.05  # m, width of the yellow line, unless a track file has another
LANE = 0.4  # m, middle of the yellow line to middle of a white one, by default
LEAST_WIDTH = 0.45  # m of road: the car is 0.28 m wide
TURNING_CIRCLE = 0.95  # m, radius: wheelbase 0.335 m / tan(0.34 rad)


@dataclass(frozen=True)
class Plane:
    """The painted rectangle: its centre and its sides, along x and y."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Circuit:
    """Everything that a course's files are made from; `origin`: the world's, in the drawing."""

    name: str
    source: str  # what it was made from, for comments and titles
    line: CentreLine
    start_s: float
    line_width: float
    lane_width: float
    plane: Plane
    walls: bool
    origin: tuple[float, float] = (0.0, 0.0)

    @property
    def half_road(self) -> float:
        """m, from the road's middle to the asphalt's edge."""
        return road_width(self.lane_width) / 2

    @property
    def start(self) -> tuple[float, float, float]:
        """x, y (m) and heading (rad) of a car at the start."""
        x, y, heading = (round(value, 9) + 0.0 for value in self.line.pose(self.start_s))
        return x, y, math.remainder(heading, 2 * math.pi)

    def track_file(self) -> TrackFile:
        """The contents of its YAML file."""
        return TrackFile(
            name=self.name,
            size=round(max(self.plane.width, self.plane.height), 3),
            model_yaw=0.0,
            line_width=self.line_width,
            lane_width=self.lane_width,
            start=self.start[:2],
            corners=self.line.corners,
        )


def road_width(lane_width: float) -> float:
    """m, from one edge of the asphalt to the other."""
    return 2 * (lane_width + EDGE_LINE / 2 + VERGE)


def lane_width(road: float) -> float:
    """m, the inverse of `road_width`, rounded to a millimetre."""
    return round(road / 2 - EDGE_LINE / 2 - VERGE, 3)

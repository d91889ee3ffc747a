"""The options of a course, whatever it is made from, and what follows for the road."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from racecar_description.track.centre_line import CentreLine
from racecar_description.track.circuit import LEAST_WIDTH, Plane, lane_width, road_width
from racecar_description.track.clearance import touching_place, widest_road
from racecar_description.track.errors import TrackError

DEFAULT_SIZE = (12.0, 8.0)  # m
BORDER = 0.5  # m of lawn round a road that needs a larger plane than given


@dataclass(frozen=True)
class Wishes:
    """The command line's options; None: as in the source. Lengths in m."""

    name: str
    size: tuple[float, float] | None = None
    width: float | None = None  # of the road
    walls: bool = False
    backwards: bool = False
    start: tuple[float, float] | None = None  # in the drawing's frame
    colour: str | None = None
    least_radius: float = 1.2


class RoadTouches(TrackError):
    """The road touches itself at `place` (x, y in m, the line's frame)."""

    def __init__(self, text: str, place: tuple[float, float]):
        super().__init__(text)
        self.place = place


def clear_lane(line: CentreLine, lane: float, wishes: Wishes, remarks: list[str]) -> float:
    """The lane's width at which the road does not touch itself.

    Raises RoadTouches for a given width that is too large; another is reduced, with a remark.
    """
    width = road_width(lane)
    place = touching_place(line, width)
    if place is None:
        return lane
    widest = int(widest_road(line, width) * 100) / 100
    if wishes.width is None and widest >= LEAST_WIDTH:
        remarks.append(f"the road is {widest:.2f} m wide, so that it does not touch itself")
        return lane_width(widest)
    advice = f"--width {widest:.2f} at most"
    if widest < LEAST_WIDTH:
        advice = "make --size larger, or leave more room between its stretches"
    where = f"x={place[0]:.2f}, y={place[1]:.2f} m"
    raise RoadTouches(f"a road {width:.2f} m wide touches itself at {where}; {advice}", place)


def check_start(wishes: Wishes, nearest: tuple[float, float], lane: float) -> None:
    """TrackError if the given start is more than a road's width from the road.

    `nearest` is the line's point (x, y in m, the drawing's frame) nearest to it.
    """
    if wishes.start is None:
        return
    width = road_width(lane)
    beside = math.dist(wishes.start, nearest) - width / 2
    if beside > width:
        asked, there = (",".join(f"{value:.6g}" for value in at) for at in (wishes.start, nearest))
        raise TrackError(f"--start {asked} is {beside:.2f} m from the road; try --start {there}")


def plane_round(line: CentreLine, lane: float, sides: np.ndarray, middle: np.ndarray) -> Plane:
    """A rectangle with these sides and centre, larger if the road needs it."""
    points = line.points()
    low = points.min(axis=0) - road_width(lane) / 2
    high = points.max(axis=0) + road_width(lane) / 2
    if (low < middle - sides / 2).any() or (high > middle + sides / 2).any():
        low = np.minimum(low - BORDER, middle - sides / 2)
        high = np.maximum(high + BORDER, middle + sides / 2)
        middle, sides = (low + high) / 2, high - low
    return Plane(*(round(float(value), 3) for value in (*middle, *sides)))

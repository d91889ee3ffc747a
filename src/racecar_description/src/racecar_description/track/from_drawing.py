"""A course from a drawing: measured, smoothed, and redrawn cleanly.

Points in the plane are complex numbers, x + iy in m of the drawing's frame.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from racecar_description.track.centre_line import CentreLine, Corner
from racecar_description.track.circuit import (
    CENTRE_LINE,
    LANE,
    LEAST_WIDTH,
    Circuit,
    lane_width,
    road_width,
)
from racecar_description.track.drawing import Fault, MidLine, find_mid_line, read_picture
from racecar_description.track.errors import DrawingError, Mark
from racecar_description.track.wishes import (
    DEFAULT_SIZE,
    RoadTouches,
    Wishes,
    check_start,
    clear_lane,
    plane_round,
)

SMOOTHED = 0.3  # share of the drawn road's width, the length of ragged edges
SMOOTHED_WIDTHS = (LEAST_WIDTH, 1.5)  # m, bounds of the width used for that
SPACING = 0.02  # m, between points of the smooth curve
CORNER = 0.25  # m, between the corners of the polygon
DIGITS = 4  # decimals of written corners: a tenth of a millimetre
WIDEST = 100.0  # m: bends of larger radius are written with this one, between straights
ODD_WIDTH = 0.2  # share of the usual half width: a larger deviation is a stain or a gap


def from_drawing(path: Path, wishes: Wishes) -> tuple[Circuit, list[str]]:
    """A course along a picture's closed road, and remarks; DrawingError if it has none."""
    picture = read_picture(path)
    try:
        mid_line = find_mid_line(picture, wishes.colour)
    except Fault as fault:
        raise DrawingError(f"{path}: {fault}", picture, fault.marks) from fault
    shape_px, remarks = picture.shape[:2], []
    scale = _scale(shape_px, wishes, remarks)
    measured = 2 * scale * float(np.median(mid_line.half_width))
    lane = _lane(measured, wishes, remarks)
    bend = SMOOTHED * float(np.clip(measured, *SMOOTHED_WIDTHS))
    curve = _curve(mid_line, scale, shape_px[0], wishes, bend)
    origin = (float(curve[0].real), float(curve[0].imag))
    line = CentreLine(_corners(curve, straight_ahead=wishes.start is None))
    try:
        lane = clear_lane(line, lane, wishes, remarks)
    except RoadTouches as error:
        x, y = (np.array(error.place) + origin) / scale - 0.5
        mark = Mark(x, shape_px[0] - 1 - y, "touches")
        raise DrawingError(f"{path}: {error}", picture, [mark]) from error
    check_start(wishes, origin, lane)
    sides = np.array(shape_px[::-1]) * scale
    course = Circuit(
        name=wishes.name,
        source=path.name,
        line=line,
        start_s=line.nearest(0.0, 0.0),
        line_width=CENTRE_LINE,
        lane_width=lane,
        plane=plane_round(line, lane, sides, sides / 2 - origin),
        walls=wishes.walls,
        origin=origin,
    )
    return course, remarks


def _scale(shape_px: tuple[int, int], wishes: Wishes, remarks: list[str]) -> float:
    """m/px at which the picture fits the wanted size; keeps its aspect ratio."""
    (height_px, width_px), (width, height) = shape_px, wishes.size or DEFAULT_SIZE
    scale = min(width / width_px, height / height_px)
    if max(width - width_px * scale, height - height_px * scale) > 0.02 * max(width, height):
        remarks.append(
            f"the picture is {width_px}x{height_px} px: to keep its shape, the plane is"
            f" {width_px * scale:.2f} x {height_px * scale:.2f} m"
        )
    return scale


def _lane(measured: float, wishes: Wishes, remarks: list[str]) -> float:
    """The wanted width, else the measured one, or the default if only a line is drawn."""
    if wishes.width is not None:
        return lane_width(wishes.width)
    if measured >= LEAST_WIDTH:
        return lane_width(measured)
    remarks.append(
        f"what is drawn is {measured:.2f} m wide, a line rather than a road: the road along it"
        f" is {road_width(LANE):.2f} m wide"
    )
    return LANE


def _curve(
    mid_line: MidLine, scale: float, height_px: int, wishes: Wishes, bend: float
) -> np.ndarray:
    """The smooth middle from its start, in driving direction."""
    x_px, y_px = mid_line.points.T
    points = (x_px + 0.5 + 1j * (height_px - y_px - 0.5)) * scale
    curve = _smooth(points, _usual(mid_line.half_width), bend)
    clockwise = np.sum(curve.conj() * np.roll(curve, -1)).imag < 0
    if clockwise != wishes.backwards:
        curve = curve[::-1]
    return _started(curve, wishes.start)


def _usual(half_width: np.ndarray) -> np.ndarray:
    """Which points are away from places where the road's width is odd."""
    usual = np.median(half_width)
    odd = np.flatnonzero(np.abs(half_width - usual) > ODD_WIDTH * usual + 1.5)
    reach = max(1, round(usual / 2))  # the middle is displaced even before the width is
    kept = np.ones(len(half_width), bool)
    kept[(odd[:, None] + np.arange(-reach, reach + 1)) % len(kept)] = False
    return kept if kept.any() else ~kept


def _smooth(points: np.ndarray, kept: np.ndarray, bend: float) -> np.ndarray:
    """A closed curve along the kept points, without waves shorter than about 2 pi `bend` (m).

    As by a spline that minimises squared third differences; circles keep their size.
    """
    along = _lengths(points)
    count = max(80, round(along[-1] / SPACING))
    places = np.arange(count) * along[-1] / count
    even = np.interp(places, along[:-1][kept], points[kept], period=along[-1])
    waves = 2 * math.pi * np.fft.fftfreq(count, along[-1] / count)
    return np.fft.ifft(np.fft.fft(even) / (1 + (bend * waves) ** 6))


def _started(curve: np.ndarray, start: tuple[float, float] | None) -> np.ndarray:
    """The curve from its point nearest to `start`, or on its straightest stretch towards +x."""
    if start is not None:
        return np.roll(curve, -int(np.argmin(np.abs(curve - complex(*start)))))
    ahead = np.roll(curve, -1) - np.roll(curve, 1)
    headings, turns = np.angle(ahead), np.abs(np.angle(np.roll(ahead, -1) / ahead))
    after = np.roll(headings, -1)
    level = np.flatnonzero(((headings <= 0) != (after <= 0)) & (np.abs(headings) < 1))
    window = max(3, min(50, len(curve) // 8))  # a metre to each side
    best = min(level, key=lambda i: np.roll(turns, window - i)[: 2 * window].max())
    share = headings[best] / (headings[best] - after[best])  # share of the way to the next point
    rolled = np.roll(curve, -best)
    return (1 - share) * rolled + share * np.roll(rolled, -1)


def _corners(curve: np.ndarray, straight_ahead: bool) -> list[Corner]:
    """Corners of a rounded polygon that follows a smooth closed curve.

    The curve's first point becomes the origin; it is on the line, midway between the last corner
    and the first one. With `straight_ahead` the line is parallel to x there.
    """
    along = _lengths(curve)
    count = max(8, round(along[-1] / CORNER))
    passed = np.interp((np.arange(count) + 0.5) * along[-1] / count, along,
                       np.append(curve, curve[0]))
    # A rounded corner passes through (1, 6, 1) / 8 of three neighbours, to fourth order.
    spread = 0.75 + 0.25 * np.cos(2 * math.pi * np.fft.fftfreq(count))
    polygon = np.fft.ifft(np.fft.fft(passed) / spread)
    polygon = np.round(polygon - (polygon[0] + polygon[-1]) / 2, DIGITS)
    if straight_ahead:
        polygon[0] = polygon[0].real
    polygon[-1] = -polygon[0]  # the last edge's middle is exactly the origin
    edges = np.roll(polygon, -1) - polygon
    turns = np.angle(edges / np.roll(edges, 1))
    room = np.minimum(np.abs(edges), np.roll(np.abs(edges), 1)) / 2
    radii = np.minimum(room / np.maximum(np.tan(np.abs(turns) / 2), 1e-9), WIDEST)
    radii = np.floor(radii * 10**DIGITS) / 10**DIGITS
    return [Corner(float(corner.real) + 0.0, float(corner.imag) + 0.0, float(radius))
            for corner, radius in zip(polygon, radii, strict=True)]


def _lengths(points: np.ndarray) -> np.ndarray:
    """(n + 1,) lengths along a closed line to each point, and back to the first."""
    return np.concatenate(([0.0], np.cumsum(np.abs(np.roll(points, -1) - points))))

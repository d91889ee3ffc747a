"""A course from a drawing: measured, smoothed, and redrawn cleanly."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from racecar_description.track import fitting
from racecar_description.track.centre_line import CentreLine
from racecar_description.track.course import (
    CENTRE_LINE,
    LANE,
    LEAST_WIDTH,
    Course,
    lane_width,
    road_width,
)
from racecar_description.track.drawing import read_picture, road_masks
from racecar_description.track.errors import DrawingError, Fault, Mark
from racecar_description.track.mid_line import MidLine
from racecar_description.track.road_finding import find_road
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


def from_drawing(path: Path, wishes: Wishes) -> tuple[Course, list[str]]:
    """A course along a picture's closed road, and remarks; DrawingError if it has none."""
    picture = read_picture(path)
    mid_line = _mid_line(path, picture, wishes.colour)
    shape_px, remarks = picture.shape[:2], []
    scale = _scale(shape_px, wishes, remarks)
    measured = 2 * scale * float(np.median(mid_line.half_width))
    lane = _lane(measured, wishes, remarks)
    bend = SMOOTHED * float(np.clip(measured, *SMOOTHED_WIDTHS))
    curve = _curve(mid_line, scale, shape_px[0], wishes, bend)
    origin = curve[0]
    line = CentreLine(fitting.to_corners(curve, straight_ahead=wishes.start is None))
    try:
        lane = clear_lane(line, lane, wishes, remarks)
    except RoadTouches as error:
        x, y = (np.array(error.place) + origin) / scale - 0.5
        mark = Mark(x, shape_px[0] - 1 - y, "touches")
        raise DrawingError(f"{path}: {error}", picture, [mark]) from error
    check_start(wishes, (float(origin[0]), float(origin[1])), lane)
    sides = np.array(shape_px[::-1]) * scale
    course = Course(
        name=wishes.name,
        source=path.name,
        line=line,
        start_s=line.nearest(0.0, 0.0),
        line_width=CENTRE_LINE,
        lane_width=lane,
        plane=plane_round(line, lane, sides, sides / 2 - origin),
        walls=wishes.walls,
        origin=(float(origin[0]), float(origin[1])),
    )
    return course, remarks


def _mid_line(path: Path, picture: np.ndarray, colour: str | None) -> MidLine:
    masks = road_masks(picture, colour)
    road = masks if isinstance(masks, Fault) else find_road(masks)
    if isinstance(road, Fault):
        raise DrawingError(f"{path}: {road.text}", picture, list(road.marks))
    return road.mid_line


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
    """The smooth middle from its start, in driving direction; (n, 2) in the drawing's frame."""
    x_px, y_px = mid_line.points.T
    points = np.column_stack((x_px + 0.5, height_px - y_px - 0.5)) * scale
    curve = fitting.smooth(points, fitting.width_weights(mid_line.half_width), bend)
    x, y = curve.T
    clockwise = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0
    if clockwise != wishes.backwards:
        curve = curve[::-1]
    return fitting.start_at(curve, wishes.start)

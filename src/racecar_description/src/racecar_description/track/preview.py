"""The preview of a course, seen from above; the picture that shows the error in a drawing."""

from __future__ import annotations

import math

import cv2
import numpy as np

from racecar_description.track.circuit import TURNING_CIRCLE, Circuit, road_width
from racecar_description.track.errors import DrawingError
from racecar_description.track.walls import THICKNESS

WIDTH_PX, BORDER_PX, HEAD_PX = 1200, 50, 60
PAPER, INK, FAINT = (30, 26, 24), (235, 232, 228), (165, 158, 152)  # BGR, as all images here
WALL, CAR, TIGHT = (200, 190, 185), (60, 60, 240), (60, 60, 255)
FONT = cv2.FONT_HERSHEY_DUPLEX


def draw_preview(course: Circuit, texture: np.ndarray, polygons: list[np.ndarray]) -> np.ndarray:
    """BGR: the painted plane with its walls, the car at the start, and rulers of the drawing."""
    width_px = WIDTH_PX - 2 * BORDER_PX
    px_per_m = width_px / course.plane.width
    height_px = round(course.plane.height * px_per_m)
    floor = cv2.resize(texture[..., ::-1], (width_px, height_px), interpolation=cv2.INTER_AREA)
    page = np.full((height_px + HEAD_PX + BORDER_PX, WIDTH_PX, 3), PAPER, np.uint8)
    page[HEAD_PX : HEAD_PX + height_px, BORDER_PX:-BORDER_PX] = floor
    view = _View(course, px_per_m)
    for polygon in polygons:
        view.line(page, polygon, WALL, max(2, round(THICKNESS * px_per_m)))
    _draw_tight_bends(page, course, view)
    _draw_car(page, course, view)
    _draw_rulers(page, course, view)
    radius = course.line.tightest()[0]
    title = (
        f"{course.name}: {course.line.length:.2f} m round, road {road_width(course.lane_width):.2f}"
        f" m, tightest bend {radius:.2f} m, {course.plane.width:g} x {course.plane.height:g} m"
    )
    cv2.putText(page, title, (BORDER_PX, 38), FONT, 0.62, INK, 1, cv2.LINE_AA)
    return page


class _View:
    """Maps world points to the page."""

    def __init__(self, course: Circuit, px_per_m: float):
        self.px_per_m = px_per_m
        plane = course.plane
        self.low = np.array((plane.x - plane.width / 2, plane.y - plane.height / 2))
        self.high = np.array((plane.x + plane.width / 2, plane.y + plane.height / 2))

    def px(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) world points as integer pixels."""
        corner = np.array((self.low[0], self.high[1]))
        pixels = (np.atleast_2d(points) - corner) * (self.px_per_m, -self.px_per_m)
        return np.round(np.add(pixels, (BORDER_PX, HEAD_PX))).astype(np.int32)

    def line(self, page: np.ndarray, points: np.ndarray, colour: tuple, thick_px: int) -> None:
        cv2.polylines(page, [self.px(points)], True, colour, thick_px, cv2.LINE_AA)


def _draw_tight_bends(page: np.ndarray, course: Circuit, view: _View) -> None:
    """Red dots along bends that the car's steering cannot follow."""
    for piece in course.line.pieces:
        if abs(piece.curvature) * TURNING_CIRCLE > 1:
            x, y, _ = piece.pose(piece.length / 2)
            cv2.circle(page, view.px((x, y))[0].tolist(), 7, TIGHT, -1, cv2.LINE_AA)


def _draw_car(page: np.ndarray, course: Circuit, view: _View) -> None:
    """An arrow head at the start, in driving direction."""
    x, y, heading = course.start
    shape = np.array([(0.45, 0.0), (0.0, 0.17), (0.1, 0.0), (0.0, -0.17)])
    cosine, sine = math.cos(heading), math.sin(heading)
    turn = np.array([[cosine, sine], [-sine, cosine]])
    corners = view.px(shape @ turn + (x, y))
    cv2.fillPoly(page, [corners], CAR, cv2.LINE_AA)
    cv2.polylines(page, [corners], True, INK, 1, cv2.LINE_AA)


def _draw_rulers(page: np.ndarray, course: Circuit, view: _View) -> None:
    """Rulers in metres of the drawing's frame, as for --start, at the bottom and on the left."""
    bottom, left = page.shape[0] - BORDER_PX, BORDER_PX
    for axis in (0, 1):
        origin = course.origin[axis]
        first, last = view.low[axis] + origin, view.high[axis] + origin
        for metre in range(math.ceil(first - 1e-6), math.floor(last + 1e-6) + 1):
            place = np.array((view.low[0], view.low[1]))
            place[axis] = metre - origin
            x, y = view.px(place)[0].tolist()
            if axis == 0:
                ends, text = ((x, bottom), (x, bottom + 6)), (x - 6, bottom + 24)
            else:
                ends, text = ((left - 6, y), (left, y)), (left - 34, y + 5)
            cv2.line(page, *ends, FAINT, 1)
            cv2.putText(page, str(metre), text, FONT, 0.45, FAINT, 1, cv2.LINE_AA)


LEAST_PX = 480  # longer side: small drawings are enlarged
RED, LIGHT, DARK = (40, 30, 230), (245, 245, 245), (30, 30, 30)
LINE_PX = 26


def draw_problem(error: DrawingError) -> np.ndarray:
    """BGR: the drawing, faded, with marks in red and the message below."""
    picture = error.picture
    larger = max(1.0, LEAST_PX / max(picture.shape[:2]))
    size = (round(picture.shape[1] * larger), round(picture.shape[0] * larger))
    page = cv2.resize(picture, size, interpolation=cv2.INTER_NEAREST)
    page = (page * 0.6 + 255 * 0.4).astype(np.uint8)
    radius = max(16, round(0.04 * max(size)))
    for mark in error.marks:
        centre = (round((mark.x_px + 0.5) * larger), round((mark.y_px + 0.5) * larger))
        cv2.circle(page, centre, radius, RED, max(3, radius // 8), cv2.LINE_AA)
        text_width = cv2.getTextSize(mark.text, FONT, 0.7, 1)[0][0]
        x = min(max(4, centre[0] - text_width // 2), max(4, size[0] - text_width - 4))
        y = centre[1] - radius - 10 if centre[1] > radius + 34 else centre[1] + radius + 28
        cv2.putText(page, mark.text, (x, y), FONT, 0.7, (255, 255, 255), 4, cv2.LINE_AA)
        cv2.putText(page, mark.text, (x, y), FONT, 0.7, RED, 1, cv2.LINE_AA)
    lines = _wrapped(str(error), size[0] - 20)
    foot = np.full((LINE_PX * len(lines) + 16, size[0], 3), LIGHT, np.uint8)
    for row, line in enumerate(lines):
        at = (10, LINE_PX * (row + 1))
        cv2.putText(foot, line, at, FONT, 0.55, DARK, 1, cv2.LINE_AA)
    return np.vstack((page, foot))


def _wrapped(text: str, width_px: int) -> list[str]:
    """The text in lines that fit; cv2 only draws ASCII."""
    lines = [""]
    for word in text.encode("ascii", "replace").decode().split():
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and cv2.getTextSize(longer, FONT, 0.55, 1)[0][0] > width_px:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines

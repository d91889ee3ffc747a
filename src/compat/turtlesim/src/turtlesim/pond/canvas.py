"""The surface that turtles draw on, in metres and pixels, and how turtles look.

They are drawn from ellipses and polygons, in several colours, seen from above.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import cv2
import numpy as np

SIDE_PX = 500
PX_PER_M = 45  # upstream's metre is the height of its turtle's image
SIDE = (SIDE_PX - 1) / PX_PER_M  # m, 11.0889
Color = tuple[int, int, int]  # red, green, blue, 0 to 255 each
Place = tuple[float, float]  # m, from the bottom left corner

_ON_EDGE_PX = 1e-6  # so that rounding does not decide about pixels just on a line's edge
_FINE = 8  # the drawing is made this many times larger, then made smaller to smooth its edges
_KEPT = 2  # how many times larger it is kept, so that it turns smoothly
_BOX_PX = 66  # side of the square that a turtle fills however it is turned


@dataclass(frozen=True)
class Pen:
    """What a turtle leaves behind; upstream's first pen."""

    color: Color = (179, 184, 255)
    width_px: int = 3
    on: bool = True


def to_px(place: Place) -> np.ndarray:
    """(2,) column and row, as floats; rows count downwards."""
    return np.array([place[0] * PX_PER_M, (SIDE - place[1]) * PX_PER_M])


class Canvas:
    """pixels: (500, 500, 3) uint8 RGB, without the turtles; `changes` counts what is drawn."""

    def __init__(self, background: Color) -> None:
        self.changes = 0
        self.pixels = np.empty((SIDE_PX, SIDE_PX, 3), np.uint8)
        self.fill(background)

    def fill(self, background: Color) -> None:
        self.pixels[:] = background
        self.changes += 1

    def line(self, start: Place, end: Place, pen: Pen) -> None:
        """As broad as the pen and as much longer, as Qt draws; not smoothed: one colour only."""
        if not pen.on:
            return
        near, far = sorted((to_px(start), to_px(end)), key=lambda point: np.abs(point).max())
        length = float(np.hypot(*(far - near)))
        ahead = (far - near) / length if length else np.array([1.0, 0.0])
        columns, rows = (self._reached(near[axis], far[axis], pen.width_px) for axis in (0, 1))
        x = np.arange(columns.start, columns.stop) - near[0]
        y = np.arange(rows.start, rows.stop)[:, None] - near[1]
        half = pen.width_px / 2 + _ON_EDGE_PX
        along, across = ahead[0] * x + ahead[1] * y + half, ahead[0] * y - ahead[1] * x + half
        inked = ((along >= 0) & (along < length + pen.width_px)
                 & (across >= 0) & (across < pen.width_px))
        self.pixels[rows, columns][inked] = pen.color
        self.changes += 1

    def color_at(self, place: Place) -> Color:
        """At a place within the pond, both ends of it included."""
        column, row = np.rint(to_px(place)).astype(int)
        red, green, blue = self.pixels[row, column]
        return int(red), int(green), int(blue)

    def _reached(self, one: float, other: float, width_px: int) -> slice:
        """The rows or columns of the surface that a line between these two can touch."""
        low, high = sorted((one, other))
        first = int(min(max(low - width_px, 0), SIDE_PX))
        return slice(first, max(first, int(min(high + width_px + 1, SIDE_PX))))


@dataclass(frozen=True)
class Look:
    skin: Color
    shell: Color
    rim: Color


LOOKS = (
    Look(skin=(126, 176, 86), shell=(92, 134, 58), rim=(54, 84, 38)),
    Look(skin=(226, 190, 120), shell=(196, 122, 58), rim=(122, 70, 34)),
    Look(skin=(110, 196, 190), shell=(38, 138, 146), rim=(18, 84, 98)),
    Look(skin=(240, 160, 150), shell=(206, 72, 76), rim=(130, 34, 48)),
    Look(skin=(196, 170, 226), shell=(128, 88, 178), rim=(76, 48, 116)),
    Look(skin=(246, 222, 130), shell=(226, 170, 34), rim=(146, 100, 18)),
    Look(skin=(190, 200, 206), shell=(112, 126, 138), rim=(62, 72, 84)),
    Look(skin=(158, 214, 120), shell=(232, 130, 46), rim=(150, 74, 22)),
)
_EYE: Color = (24, 24, 32)

# In lengths of a turtle, x towards its head, y to its left: centre x, y, half axes, turned by deg.
_FRONT_LEG = (0.235, 0.295, 0.17, 0.075, 52)
_HIND_LEG = (-0.245, 0.265, 0.13, 0.07, 135)
_HEAD = (0.415, 0.0, 0.125, 0.105, 0)
_TAIL = ((-0.34, 0.05), (-0.5, 0.0), (-0.34, -0.05))
_EYE_SPOT = (0.455, 0.062, 0.026, 0.026, 0)
_RIM = (0.0, 0.0, 0.36, 0.315, 0)
_SHELL = (0.0, 0.0, 0.32, 0.275, 0)
_SCUTE_RADIUS = 0.155
_SCUTE_LINE = 0.022


def draw_turtle(picture: np.ndarray, place: Place, theta: float, look: int) -> None:
    """Onto a (height, width, 3) uint8 RGB picture, its centre at `place` (m), heading theta."""
    column, row = to_px(place)
    left, top = (math.floor(v) - _BOX_PX // 2 for v in (column, row))
    middle = _BOX_PX * _KEPT / 2
    turn = cv2.getRotationMatrix2D((middle, middle), math.degrees(theta), 1 / _KEPT)
    turn[:, 2] += np.array([column - left, row - top]) - middle
    turned = cv2.warpAffine(_drawing(look), turn, (_BOX_PX, _BOX_PX), flags=cv2.INTER_LINEAR)
    rows, columns = (_within(start, size) for start, size in zip((top, left), picture.shape))
    if rows.start == rows.stop or columns.start == columns.stop:
        return
    seen = turned[rows.start - top : rows.stop - top, columns.start - left : columns.stop - left]
    behind = picture[rows, columns] * (1 - seen[..., 3:])
    picture[rows, columns] = np.rint(seen[..., :3] + behind)


def _within(start: int, size: int) -> slice:
    """The box's part of a picture that is `size` pixels long; empty where there is none."""
    first = min(max(0, start), size)
    return slice(first, max(first, min(size, start + _BOX_PX)))


@functools.cache
def _drawing(look: int) -> np.ndarray:
    """(side, side, 4) float32, heading right: RGB 0 to 255 times alpha, and alpha 0 to 1."""
    side = _BOX_PX * _FINE
    fine = np.zeros((side, side, 4), np.uint8)
    _draw(fine, LOOKS[look])
    kept = cv2.resize(fine, (_BOX_PX * _KEPT, _BOX_PX * _KEPT), interpolation=cv2.INTER_AREA)
    drawing = kept.astype(np.float32)
    drawing[..., 3] /= 255
    return drawing


def _draw(image: np.ndarray, look: Look) -> None:
    for leg in (_FRONT_LEG, _HIND_LEG):
        _both_sides(image, leg, look.skin)
    _fill(image, _TAIL, look.skin)
    _fill(image, _ellipse(*_HEAD), look.skin)
    _both_sides(image, _EYE_SPOT, _EYE)
    _fill(image, _ellipse(*_RIM), look.rim)
    _fill(image, _ellipse(*_SHELL), look.shell)
    corners = [_polar(_SCUTE_RADIUS, 60 * i) for i in range(6)]
    for i, corner in enumerate(corners):
        _stroke(image, corner, corners[i - 1], look.rim)
        _stroke(image, corner, _polar(0.29, 60 * i), look.rim)


def _both_sides(image: np.ndarray, ellipse: tuple[float, ...], color: Color) -> None:
    x, y, long, short, turned_deg = ellipse
    _fill(image, _ellipse(x, y, long, short, turned_deg), color)
    _fill(image, _ellipse(x, -y, long, short, -turned_deg), color)


def _ellipse(x: float, y: float, long: float, short: float, turned_deg: float) -> np.ndarray:
    """(60, 2) points of its edge."""
    angle, turned = np.linspace(0, 2 * np.pi, 60, endpoint=False), np.radians(turned_deg)
    along, across = long * np.cos(angle), short * np.sin(angle)
    return np.stack([x + along * np.cos(turned) - across * np.sin(turned),
                     y + along * np.sin(turned) + across * np.cos(turned)], axis=1)


def _polar(radius: float, angle_deg: float) -> tuple[float, float]:
    angle = math.radians(angle_deg)
    return radius * math.cos(angle), radius * math.sin(angle)


def _fine_px(points: object) -> np.ndarray:
    """Turtle lengths to pixels of the fine drawing."""
    flipped = np.asarray(points, float) * (1, -1)
    return np.rint((flipped * PX_PER_M + _BOX_PX / 2) * _FINE).astype(np.int32)


def _fill(image: np.ndarray, points: object, color: Color) -> None:
    cv2.fillPoly(image, [_fine_px(points)], (*color, 255))


def _stroke(image: np.ndarray, start: object, end: object, color: Color) -> None:
    width_px = round(_SCUTE_LINE * PX_PER_M * _FINE)
    ends = (tuple(point.tolist()) for point in _fine_px((start, end)))
    cv2.line(image, *ends, (*color, 255), width_px)

"""Top views for videos, in pixels: a part of the world, with objects and robots on it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import cv2
import numpy as np
from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import TrackFile

from evaluation.colours import FLOOR, GRID, LINE, TEXT, WHITE, bgr

FONT = cv2.FONT_HERSHEY_DUPLEX
SHIFT = 4  # cv2 draws between pixels when coordinates are given in sixteenths
HEAD = np.array([(0.6, 0.0), (-0.4, 0.375), (-0.2, 0.0), (-0.4, -0.375)])  # of an arrow of length 1


class Plan:
    """A view of the area between two corners (x, y), m, scaled to a width; y points up."""

    def __init__(self, low: Sequence[float], high: Sequence[float], width_px: int):
        self._low, self._high = np.asarray(low, float), np.asarray(high, float)
        self.px_per_m = width_px / (self._high[0] - self._low[0])
        height_px = round((self._high[1] - self._low[1]) * self.px_per_m)
        self.image = np.full((height_px, width_px, 3), bgr(FLOOR), np.uint8)

    def copy(self) -> Plan:
        """A copy that can be drawn on further."""
        other = Plan(self._low, self._high, self.image.shape[1])
        other.image = self.image.copy()
        return other

    def to_px(self, points: Iterable[Sequence[float]]) -> np.ndarray:
        """World points (n, 2) as pixel coordinates (n, 2), float."""
        points = np.asarray(points, float).reshape(-1, 2)
        return (points - (self._low[0], self._high[1])) * (self.px_per_m, -self.px_per_m)

    def grid(self, step: float) -> None:
        """Draw grid lines `step` metres apart."""
        for axis in (0, 1):
            first, last = math.ceil(self._low[axis] / step), math.floor(self._high[axis] / step)
            for number in range(first, last + 1):
                ends = np.array((self._low, self._high))
                ends[:, axis] = number * step
                self.line(ends, GRID)

    def line(self, points: Iterable[Sequence[float]], colour: str, thick_px: int = 1,
             closed: bool = False) -> None:
        """Draw a line through points (n, 2) of the world, m, anti-aliased."""
        pixels = _fixed(self.to_px(points))
        if len(pixels) > 1:
            cv2.polylines(self.image, [pixels], closed, bgr(colour), thick_px, cv2.LINE_AA, SHIFT)

    def disc(self, place: Sequence[float], radius: float, colour: str) -> None:
        """Draw a disc; place and radius in m."""
        centre = _fixed(self.to_px([place]))[0].tolist()
        cv2.circle(self.image, centre, round(radius * self.px_per_m * (1 << SHIFT)), bgr(colour),
                   -1, cv2.LINE_AA, SHIFT)

    def dots(self, points: np.ndarray, colour: str) -> None:
        """Draw dots, 3 px wide, at points (n, 2), m."""
        for x, y in np.round(self.to_px(points)).astype(int).tolist():
            cv2.rectangle(self.image, (x - 1, y - 1), (x + 1, y + 1), bgr(colour), -1)

    def arrow(self, pose: Sequence[float], length: float, colour: str) -> None:
        """Draw an arrow head (length in m) with its reference point at x, y, yaw."""
        corners = _fixed(self.to_px(arrow(pose, length)))
        cv2.fillPoly(self.image, [corners], bgr(colour), cv2.LINE_AA, SHIFT)
        cv2.polylines(self.image, [corners], True, (255, 255, 255), 1, cv2.LINE_AA, SHIFT)


def course_plan(track_file: TrackFile, width_px: int, margin: float = 0.15) -> Plan:
    """A view of the floor with a 0.5 m grid, the two lines and the start."""
    yellow = build_track(track_file)
    white = yellow.offset(-track_file.lane_width)
    points = np.array(yellow.points() + white.points())
    plan = Plan(points.min(axis=0) - margin, points.max(axis=0) + margin, width_px)
    plan.grid(0.5)
    for line, colour in ((white, WHITE), (yellow, LINE)):
        plan.line(line.points(), colour, max(2, round(track_file.line_width * plan.px_per_m)),
                  closed=True)
    plan.line(start_mark(yellow.pose(0.0)), TEXT, 2)
    return plan


def start_mark(pose: Sequence[float]) -> np.ndarray:
    """Ends (2, 2) of a short line across the track's start."""
    x, y, heading = pose
    across = 0.07 * np.array((math.sin(heading), -math.cos(heading)))
    return np.array((x, y)) + np.array((-across, across))


def arrow(pose: Sequence[float], length: float) -> np.ndarray:
    """Corners (4, 2) of an arrow head with its reference point at x, y, yaw; m, rad."""
    x, y, yaw = pose
    turn = np.array([(math.cos(yaw), math.sin(yaw)), (-math.sin(yaw), math.cos(yaw))])
    return length * HEAD @ turn + (x, y)


def write_text(image: np.ndarray, text: str, at_px: tuple[int, int], height_px: int,
               colour: tuple = bgr(TEXT)) -> int:
    """Draw text with its baseline's left end at a pixel; returns its width in px."""
    thick = 2 if height_px > 24 else 1
    scale = cv2.getFontScaleFromHeight(FONT, height_px, thick)
    cv2.putText(image, text, at_px, FONT, scale, colour, thick, cv2.LINE_AA)
    return cv2.getTextSize(text, FONT, scale, thick)[0][0]


def _fixed(points_px: np.ndarray) -> np.ndarray:
    return np.round(np.asarray(points_px) * (1 << SHIFT)).astype(np.int32)

"""The settings of lane_follow; the yellow line in an image, and its points on the ground.

Ground points are (x forward, y left) in m from the middle of the rear axle. Yellow is the smaller
of red and green minus blue: white, grey, green and blue have little of it in any light.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from node_basics.settings import number


@dataclass(frozen=True)
class LaneSettings:
    """SI units; the camera's pose is from the ground below the middle of the rear axle."""

    camera_forward: float = number(-2, 2, "m")
    camera_left: float = number(-2, 2, "m")
    camera_height: float = number(0.02, 3, "m")
    camera_pitch: float = number(-0.5, 1.5, "rad, downwards positive")
    camera_hfov: float = number(0.2, 3, "rad, horizontal field of view")
    line_width: float = number(0.005, 0.5, "m")
    line_contrast: float = number(1, 255, "least difference of min(red, green) and blue, of 255")
    sight: float = number(0.3, 10, "m from the camera, farthest place searched")

    wheelbase: float = number(0.05, 5, "m")
    max_steering_angle: float = number(0.05, 1.2, "rad")
    latency: float = number(0, 0.5, "s from image to wheels")
    kp: float = number(0, 50, "rad of steering per m of error")
    ki: float = number(0, 50, "rad per m s")
    kd: float = number(0, 50, "rad s per m")
    derivative_time: float = number(0, 1, "s, time constant of the derivative's low-pass")

    max_speed: float = number(0, 20, "m/s")
    lateral_acceleration: float = number(0.1, 20, "m/s^2 in bends")
    acceleration: float = number(0.1, 20, "m/s^2")
    braking: float = number(0.1, 20, "m/s^2")
    error_slowdown: float = number(0.01, 10, "m of error that halves the speed")
    search_speed: float = number(0, 5, "m/s at the line's end or while it is lost")
    search_time: float = number(0, 60, "s of searching before it stops")
    image_timeout: float = number(0.1, 10, "s without an image before it stops")


ROWS = 24  # searched; denser on the ground near the car
BAND = 3  # rows averaged into one, to reduce noise
WIDEST = 4.0  # times the line's width: longest cut of a row through a line that runs across
FIRST_GATE = 0.6  # m from the expected place, for the first point
GATE, GATE_SLOPE = 0.06, 0.6  # m, and m per m of distance, from the extrapolated points


@dataclass(frozen=True)
class Line:
    """Points of the line, the nearest first."""

    ground: np.ndarray  # (n, 2) m
    pixels: np.ndarray  # (n, 2) column, row


@dataclass(frozen=True)
class Rows:
    """The image rows that are searched, the nearest first."""

    row: np.ndarray  # (n,) px
    x: np.ndarray  # (n,) m ahead of the rear axle
    px_per_m: np.ndarray  # (n,) across
    middle: float  # px, the column straight ahead of the camera


def find_line(image: np.ndarray, settings: LaneSettings, expected: float = 0.0) -> Line:
    """The line in a BGR image (h, w, 3) uint8 of any size; no points if there is none.

    expected: about where the line's nearest point should be, m to the left.
    """
    if min(image.shape[:2]) < BAND:
        return Line(np.empty((0, 2)), np.empty((0, 2)))
    rows = plan_rows(image.shape[0], image.shape[1], settings)
    yellow = _yellowness(image, rows.row)
    pieces = _bright_pieces(yellow, rows.px_per_m * settings.line_width, settings.line_contrast)
    points: list[tuple[float, float]] = []
    pixels: list[tuple[float, float]] = []
    for i, columns in enumerate(pieces):
        if not columns:
            continue
        lateral = settings.camera_left + (rows.middle - np.array(columns)) / rows.px_per_m[i]
        guess, gate = _guess(points, float(rows.x[i]), expected)
        best = int(np.argmin(np.abs(lateral - guess)))
        if abs(lateral[best] - guess) <= gate:
            points.append((float(rows.x[i]), float(lateral[best])))
            pixels.append((columns[best], float(rows.row[i])))
    return Line(np.array(points).reshape(-1, 2), np.array(pixels).reshape(-1, 2))


@lru_cache(maxsize=8)
def plan_rows(height_px: int, width_px: int, settings: LaneSettings) -> Rows:
    """Rows from the bottom of the image to `sight`, spaced evenly in the log of the distance."""
    focal_px = width_px / 2 / math.tan(settings.camera_hfov / 2)
    c, s = math.cos(settings.camera_pitch), math.sin(settings.camera_pitch)
    height = settings.camera_height
    up = -(height_px / 2 - 1 - BAND // 2) / focal_px  # slope of the lowest row's direction
    down = s - up * c
    if down <= 0:
        # The camera only sees the sky.
        return Rows(np.zeros(0, int), np.zeros(0), np.zeros(0), width_px / 2)
    nearest = height * (c + up * s) / down
    distance = np.geomspace(max(nearest, 0.02), max(settings.sight, 1.1 * nearest), ROWS)
    up = (distance * s - height * c) / (height * s + distance * c)
    row = np.rint(height_px / 2 - focal_px * up).astype(int)
    row = np.unique(np.clip(row, BAND // 2, height_px - 1 - BAND // 2))
    up = (height_px / 2 - row - 0.5) / focal_px
    depth = height / (s - up * c)  # m along the camera's axis
    x = settings.camera_forward + depth * (c + up * s)
    return Rows(row[::-1], x[::-1], (focal_px / depth)[::-1], width_px / 2)


def _yellowness(image: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(rows, w) float: min(red, green) minus blue, averaged over BAND rows."""
    bands = image[rows[:, None] + np.arange(BAND) - BAND // 2].astype(np.int16)
    blue, green, red = bands[..., 0], bands[..., 1], bands[..., 2]
    return (np.minimum(red, green) - blue).mean(axis=1)


def _bright_pieces(yellow: np.ndarray, width_px: np.ndarray, contrast: float) -> list[list[float]]:
    """For each row, the middles (columns) of the pieces that are about as wide as the line."""
    pieces = []
    columns = np.arange(yellow.shape[1])
    for values, width in zip(yellow, width_px):
        size = max(1, round(width / 2))
        smooth = np.convolve(values, np.full(size, 1 / size), mode="same")
        edges = np.flatnonzero(np.diff(np.concatenate([[0], smooth > contrast, [0]])))
        found = []
        for begin, end in zip(edges[::2], edges[1::2]):
            weights = np.maximum(values[begin:end], 0)
            total = weights.sum()
            if total > 0 and width / 3 <= end - begin <= WIDEST * width + size:
                found.append(float((weights * columns[begin:end]).sum() / total) + 0.5)
        pieces.append(found)
    return pieces


def _guess(points: list[tuple[float, float]], x: float, expected: float) -> tuple[float, float]:
    """Where (m to the left) the line should be at x, and the tolerance, m."""
    if not points:
        return expected, FIRST_GATE
    (x1, y1), (x0, y0) = points[-1], points[max(-3, -len(points))]
    slope = (y1 - y0) / (x1 - x0) if len(points) > 1 else 0.0
    way = x - x1
    gate = GATE + GATE_SLOPE * way * (1 if len(points) > 1 else 2)
    return y1 + slope * way, gate

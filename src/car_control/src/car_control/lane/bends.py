"""The curvature along a line of points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

FEWEST = 4  # points needed to fit a bend


@dataclass(frozen=True)
class Bend:
    """The line near one place, in the frame of its points."""

    s: float  # m along the line, from its first point
    x: float  # m
    y: float  # m
    heading: float  # rad
    curvature: float  # 1/m, left positive


def bends_along(points: np.ndarray, spacing: float, window: float) -> list[Bend]:
    """Bends at the first point and every `spacing` m; none for fewer than FEWEST points.

    points: (n, 2) m, in order. window: m of line to which each parabola is fitted, half of it on
    each side, if the line is that long.
    """
    if len(points) < FEWEST:
        return []
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return [_fit(points, s, place, window) for place in np.arange(0.0, s[-1], spacing)]


def _fit(points: np.ndarray, s: np.ndarray, place: float, window: float) -> Bend:
    begin = max(0.0, min(place - window / 2, s[-1] - window))
    near = points[(s >= begin - 1e-9) & (s <= begin + window)]
    if len(near) < FEWEST:
        first = int(np.clip(np.searchsorted(s, place) - FEWEST // 2, 0, len(points) - FEWEST))
        near = points[first : first + FEWEST]
    middle = np.array([np.interp(place, s, points[:, k]) for k in (0, 1)])
    turned = math.atan2(*(near[-1] - near[0])[::-1])
    c, d = math.cos(turned), math.sin(turned)
    along, across = ((near - middle) @ np.array([[c, -d], [d, c]])).T
    c2, c1, c0 = np.polyfit(along, across, 2)
    x, y = middle + c0 * np.array((-d, c))
    # A parabola's curvature falls off from its vertex, a road's does not: use the vertex's.
    return Bend(place, float(x), float(y), turned + math.atan(c1), float(2 * c2))

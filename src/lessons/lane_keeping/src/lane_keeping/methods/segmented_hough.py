"""Segmented Hough: straight line pieces in each of a few segments of rows, joined to curves.

In such a low segment a bend is nearly straight, so Hough's straight pieces can follow it.
"""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.lane import Marks, Plan, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

SEGMENTS = 5
VOTES = 15
LEAST_LENGTH = 0.4  # of a segment's height
GAP_PX = 8


def pieces(edges: np.ndarray, low: int, high: int) -> np.ndarray:
    """(n, 4) x0, y0, x1, y1 in px of the straight pieces in these rows; y0 is the lower end."""
    found = cv2.HoughLinesP(
        edges[low:high], 1, np.pi / 90, VOTES,
        minLineLength=LEAST_LENGTH * (high - low), maxLineGap=GAP_PX,
    )
    lines = np.empty((0, 4)) if found is None else found[:, 0].astype(float)
    lines[:, 1::2] += low
    upside_down = lines[:, 1] < lines[:, 3]
    lines[upside_down] = lines[upside_down][:, [2, 3, 0, 1]]
    return lines


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    outline = cv2.morphologyEx(mask, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8))
    outline[:, [0, 1, -2, -1]] = 0  # the image's border is not a line
    borders = np.linspace(len(mask), 0, SEGMENTS + 1).astype(int)
    middle, found = mask.shape[1] / 2, ([], [])
    for low, high in zip(borders[1:], borders[:-1]):
        lines = pieces(outline, low, high)
        centres = (lines[:, 0] + lines[:, 2]) / 2
        for side, chosen in zip(found, (centres < middle, centres >= middle)):
            side.append(lines[chosen].reshape(-1, 2))
        middle = _middle(lines, centres < middle, middle, view, (low + high) / 2)
    left, right = (np.concatenate(side) for side in found)
    marks = Marks(points=np.concatenate([left, right]))
    return steer_by_error(make_lane(fit_side(left), fit_side(right), view, marks), view, settings)


def _middle(
    lines: np.ndarray, on_left: np.ndarray, before: float, view: RoadView, row: float
) -> float:
    """The lane's middle at a segment's upper end, which divides the next segment."""
    half = view.lane_width_px(row) / 2
    left, right = lines[on_left, 2], lines[~on_left, 2]
    if len(left) and len(right):
        return float(left.max() + right.min()) / 2
    if len(left):
        return float(left.max()) + half
    return float(right.min()) - half if len(right) else before

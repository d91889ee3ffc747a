"""Banded centroids: in each band of rows, the centroid of the pixels on either side of the middle.

The middle follows from band to band what was found. There is no search, which makes it fast, but
lets every stray pixel have an effect.
"""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.lane import Marks, Plan, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

BANDS = 12


def centroid(mask: np.ndarray) -> float | None:
    """The mean column of a mask's pixels, or None if it has none."""
    moments = cv2.moments(mask, binaryImage=True)
    return moments["m10"] / moments["m00"] if moments["m00"] else None


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    rows, columns = mask.shape
    edges = np.linspace(rows, 0, BANDS + 1).astype(int)
    middle, found = columns / 2, ([], [])
    for low, high in zip(edges[1:], edges[:-1]):
        row, width = (low + high) / 2, view.lane_width_px((low + high) / 2)
        split = int(np.clip(middle, 1, columns - 1))
        left, right = centroid(mask[low:high, :split]), centroid(mask[low:high, split:])
        if left is not None:
            found[0].append((left, row))
        if right is not None:
            right += split
            found[1].append((right, row))
        if left is not None and right is not None:
            middle = (left + right) / 2
        elif left is not None:
            middle = left + width / 2
        elif right is not None:
            middle = right - width / 2
    left, right = (np.array(points).reshape(-1, 2) for points in found)
    marks = Marks(points=np.concatenate([left, right]))
    return steer_by_error(make_lane(fit_side(left), fit_side(right), view, marks), view, settings)

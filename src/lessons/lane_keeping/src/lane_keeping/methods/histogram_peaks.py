"""Histogram peaks: for each strip of rows a column histogram, and its two peaks that form a lane.

Of all pairs of peaks about a lane apart, the one nearest to the centre line so far is used; a
single peak is taken as the side that it is nearer to.
"""

from __future__ import annotations

import numpy as np

from lane_keeping.lane import Marks, Plan, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

STRIPS = 16
SMOOTHING = 9  # columns
LEAST = 0.25  # least share of the strip's rows in a peak
CLOSEST, FARTHEST = 0.75, 1.5  # lane widths between the two peaks of a pair


def peaks(histogram: np.ndarray, least: float) -> np.ndarray:
    """The middle columns of all runs in which the smoothed histogram reaches `least`."""
    smooth = np.convolve(histogram, np.ones(SMOOTHING) / SMOOTHING, "same")
    edges = np.flatnonzero(np.diff(np.concatenate([[0], smooth >= least, [0]])))
    return (edges[::2] + edges[1::2] - 1) / 2


def choose(
    columns: np.ndarray, middle: float, width: float
) -> tuple[float | None, float | None]:
    """The columns of the left and right line among the peaks, given where the lane should be."""
    pairs = [
        (abs((a + b) / 2 - middle) + abs(b - a - width), a, b)
        for i, a in enumerate(columns)
        for b in columns[i + 1 :]
        if CLOSEST * width < b - a < FARTHEST * width
    ]
    if pairs:
        return min(pairs)[1:]
    lefts, rights = np.abs(columns - (middle - width / 2)), np.abs(columns - (middle + width / 2))
    if not len(columns) or min(lefts.min(), rights.min()) > width / 2:
        return None, None
    if lefts.min() < rights.min():
        return float(columns[lefts.argmin()]), None
    return None, float(columns[rights.argmin()])


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    edges = np.linspace(len(mask), 0, STRIPS + 1).astype(int)
    middle, found = mask.shape[1] / 2, ([], [])
    for low, high in zip(edges[1:], edges[:-1]):
        row, width = (low + high) / 2, view.lane_width_px((low + high) / 2)
        histogram = np.count_nonzero(mask[low:high], axis=0)
        left, right = choose(peaks(histogram, LEAST * (high - low)), middle, width)
        if left is not None:
            found[0].append((left, row))
        if right is not None:
            found[1].append((right, row))
        if left is not None or right is not None:
            middle = ((right - width if left is None else left)
                      + (left + width if right is None else right)) / 2
    left, right = (np.array(points).reshape(-1, 2) for points in found)
    marks = Marks(points=np.concatenate([left, right]))
    return steer_by_error(make_lane(fit_side(left), fit_side(right), view, marks), view, settings)

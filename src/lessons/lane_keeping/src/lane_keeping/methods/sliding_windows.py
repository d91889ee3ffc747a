"""Sliding windows: from the histogram's two peaks upwards, each window follows the one below."""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.lane import Marks, Plan, Side, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings


def bases(mask: np.ndarray, min_pixels: int) -> tuple[int | None, int | None]:
    """The columns with most line pixels in the mask's lower half, one per side.

    None for a side whose best column and its neighbours have fewer than min_pixels.
    """
    histogram = np.count_nonzero(mask[mask.shape[0] // 2 :], axis=0)
    histogram = np.convolve(histogram, np.ones(9, int), "same")  # a slanted line spreads over many
    middle = len(histogram) // 2
    found = []
    for begin, half in ((0, histogram[:middle]), (middle, histogram[middle:])):
        peak = int(half.argmax())
        found.append(begin + peak if half[peak] >= min_pixels else None)
    return found[0], found[1]


def climb(
    mask: np.ndarray, base: int, settings: Settings
) -> tuple[Side | None, list[tuple[int, int, int, int]]]:
    """Follow one line from its base upwards: its curve, and the windows searched.

    After a window without enough pixels, the next one is straight above it.
    """
    rows, columns = mask.shape
    edges = np.unique(np.linspace(0, rows, settings.windows + 1).astype(int))[::-1]
    centre, boxes, taken = float(base), [], []
    for low, high in zip(edges[1:], edges[:-1]):
        left = max(round(centre) - settings.margin_px, 0)
        right = min(round(centre) + settings.margin_px, columns)
        boxes.append((left, int(low), right, int(high)))
        found = cv2.findNonZero(mask[low:high, left:right])
        if found is not None and len(found) >= settings.min_pixels:
            taken.append(found[:, 0] + [left, low])
            centre = float(taken[-1][:, 0].mean())
    return (fit_side(np.concatenate(taken)) if taken else None), boxes


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """The tutorial's method; see the package for the common signature."""
    sides, boxes = [], []
    for base in bases(mask, settings.min_pixels):
        side, windows = (None, []) if base is None else climb(mask, base, settings)
        sides.append(side)
        boxes += windows
    return steer_by_error(make_lane(*sides, view, Marks(tuple(boxes))), view, settings)

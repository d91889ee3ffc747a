"""Skeleton: lines thinned to their middle, and the longest branch on either side of the lane.

Thinning is Lantuejoul's: what openings remove from the mask while it is eroded step by step.
"""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.lane import Marks, Plan, Side, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
MAX_STEPS = 40  # a line is at most twice as wide, px


def thin(mask: np.ndarray) -> np.ndarray:
    """The skeleton of a mask, as a mask. It may have gaps of a pixel or two."""
    left, skeleton = mask.copy(), np.zeros_like(mask)
    for _ in range(MAX_STEPS):
        eroded = cv2.erode(left, CROSS)
        skeleton |= left & ~cv2.dilate(eroded, CROSS)
        left = eroded
        if not cv2.countNonZero(left):
            break
    return skeleton


def branches(skeleton: np.ndarray, min_pixels: int) -> list[np.ndarray]:
    """(n, 2) pixels of each branch with at least `min_pixels`; gaps of 4 px are bridged."""
    joined = cv2.dilate(skeleton, np.ones((5, 5), np.uint8))
    count, labels, _, _ = cv2.connectedComponentsWithStats(joined, connectivity=8)
    rows, columns = np.nonzero(skeleton)
    owner = labels[rows, columns]
    points = np.stack([columns, rows], axis=1)
    found = [points[owner == i] for i in range(1, count)]
    return [branch for branch in found if len(branch) >= min_pixels]


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    skeleton = thin(mask)
    found = branches(skeleton, settings.min_pixels)
    middle = mask.shape[1] / 2
    sides: list[Side | None] = []
    for on_left in (True, False):
        mine = [branch for branch in found if (_foot(branch) < middle) == on_left]
        sides.append(fit_side(max(mine, key=_height)) if mine else None)
    points = np.concatenate(found)[::4] if found else np.empty((0, 2))
    return steer_by_error(make_lane(*sides, view, Marks(points=points)), view, settings)


def _foot(branch: np.ndarray) -> float:
    """The column of a branch's lower end."""
    low = branch[:, 1] > branch[:, 1].max() - 10
    return float(branch[low, 0].mean())


def _height(branch: np.ndarray) -> int:
    return int(np.ptp(branch[:, 1]))

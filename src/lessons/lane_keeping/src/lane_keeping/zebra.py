"""Finds a zebra crossing's white bars in a bird's-eye view of the road."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from lane_keeping.road_view import RoadView

NEAR, FAR, ASIDE = 0.45, 2.7, 0.7  # m covered by the view: ahead of the axle, and to either side
PX_PER_M = 80
NARROWEST_BAR, WIDEST_BAR = 0.05, 0.2  # m
LEAST_LENGTH = 0.2  # m, of a bar and of a crossing
CONTRAST = 0.15  # least share by which a bar is brighter than the road
LEAST_BARS = 3  # side by side


@dataclass(frozen=True)
class Zebra:
    """Where a crossing starts and ends, in m ahead of the axle."""

    near: float
    far: float

    @property
    def reaches_robot(self) -> bool:
        """Whether it starts at the view's near end: then its near edge was not seen."""
        return self.near < NEAR + 2 / PX_PER_M


def from_above(grey: np.ndarray, view: RoadView) -> np.ndarray | None:
    """The road's brightness seen from above, far rows first, left columns first.

    grey: (h, w) uint8, the whole image. NEAR, FAR, ASIDE and PX_PER_M define the view. None if the
    camera cannot see it.
    """
    size = (round(2 * ASIDE * PX_PER_M), round((FAR - NEAR) * PX_PER_M))
    ground = np.array([[FAR, ASIDE], [FAR, -ASIDE], [NEAR, ASIDE], [NEAR, -ASIDE]])
    there = np.array([[0, 0], [size[0], 0], [0, size[1]], size], np.float32)
    here = view.to_picture(ground).astype(np.float32)
    if not np.isfinite(here).all():
        return None
    turn = cv2.getPerspectiveTransform(here, there)
    return cv2.warpPerspective(grey, turn, size, borderMode=cv2.BORDER_REPLICATE)


def bars(road: np.ndarray) -> np.ndarray:
    """255 where the road is brighter than beside it, in strips along the road."""
    across = np.ones((1, round(WIDEST_BAR * PX_PER_M)), np.uint8)
    level = cv2.morphologyEx(road, cv2.MORPH_OPEN, across)
    mask = cv2.compare(road, cv2.convertScaleAbs(level, alpha=1 + CONTRAST, beta=4), cv2.CMP_GT)
    smallest = np.ones((round(LEAST_LENGTH * PX_PER_M), round(NARROWEST_BAR * PX_PER_M)), np.uint8)
    return cv2.morphologyEx(mask, cv2.MORPH_OPEN, smallest)


def find_zebra(grey: np.ndarray, view: RoadView) -> Zebra | None:
    """The nearest crossing ahead, or None."""
    road = from_above(grey, view)
    if road is None:
        return None
    mask = bars(road) > 0
    begins = mask & ~np.pad(mask, ((0, 0), (1, 0)))[:, :-1]
    striped = np.count_nonzero(begins, axis=1) >= LEAST_BARS
    edges = np.flatnonzero(np.diff(np.concatenate([[0], striped, [0]])))
    least = LEAST_LENGTH * PX_PER_M
    runs = [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b - a >= least]
    if not runs:
        return None
    begin, end = runs[-1]
    return Zebra(near=FAR - end / PX_PER_M, far=FAR - begin / PX_PER_M)

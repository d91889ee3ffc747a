"""Finds people: upright coloured blobs that stand on the ground.

Road, lines and zebra have no colour, lawn and trees are green or brown; any other strong colour is
clothing. Only the part below the horizon is searched: on flat ground that is what is below the
lens's height, people's legs.
"""

from __future__ import annotations

import cv2
import numpy as np

from lane_keeping.road_view import RoadView

SHRINK = 2  # only every second pixel is used
SATURATION, VALUE = 110, 35  # of 255, at least
BROWN_TO_GREEN = (8, 90)  # OpenCV's hue, 0..180: lawn, leaves, trunks
BROWN_VALUE = 140  # brighter and not green is orange or yellow, not brown
GREEN_HUE = 32
LEAST_HEIGHT, LEAST_WIDTH = 0.2, 0.05  # m
FARTHEST = 4.0  # m


def clothing(image: np.ndarray) -> np.ndarray:
    """(h, w, 3) BGR to a mask: 255 where the colour is strong and neither green nor brown."""
    hue, saturation, value = cv2.split(cv2.cvtColor(image, cv2.COLOR_BGR2HSV))
    natural = (hue >= BROWN_TO_GREEN[0]) & (hue <= BROWN_TO_GREEN[1])
    natural &= (value < BROWN_VALUE) | (hue >= GREEN_HUE)
    strong = (saturation >= SATURATION) & (value >= VALUE)
    return np.where(strong & ~natural, 255, 0).astype(np.uint8)


def find_people(image: np.ndarray, view: RoadView) -> np.ndarray:
    """(n, 2) m on the ground (ahead, left): the feet of all people in the BGR image."""
    horizon = max(round(view.horizon), 0)
    if horizon >= len(image):
        return np.empty((0, 2))
    below = np.ascontiguousarray(image[horizon::SHRINK, ::SHRINK])
    mask = cv2.morphologyEx(clothing(below), cv2.MORPH_CLOSE, np.ones((3, 3), np.uint8))
    count, _, boxes, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
    feet = [_feet(box, horizon - view.top, view) for box in boxes[1:count]]
    return np.array([one for one in feet if one is not None]).reshape(-1, 2)


def _feet(box: np.ndarray, horizon: int, view: RoadView) -> np.ndarray | None:
    """Where a blob stands, if it is upright and large enough to be a person; else None.

    box: left, top, width, height, area in px of the shrunken image; horizon: row in the region.
    """
    left, top, width, height = (box[:4] * SHRINK).astype(float)
    foot = np.array([left + width / 2, horizon + top + height])
    ground = view.to_ground(foot)
    away = ground[0] - view.forward
    if not 0 < away < FARTHEST:
        return None
    metres_a_px = np.hypot(away, view.lens_height) / view.focal
    if height * metres_a_px < LEAST_HEIGHT or width * metres_a_px < LEAST_WIDTH:
        return None
    return ground

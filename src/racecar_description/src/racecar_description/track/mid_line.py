"""The line in the middle of a closed road: as far from the infield as from the outside.

This needs no thinning and gives no branches: the middle is where two distances are equal, to
subpixel precision. Coordinates are in px, x right and y down, pixel centres at integers.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

NEWTON_STEPS = 5


@dataclass(frozen=True)
class MidLine:
    """(n, 2) points along the road, in order, and the road's half width (n,) there; px."""

    points: np.ndarray
    half_width: np.ndarray


def find_mid_line(road: np.ndarray, infield: np.ndarray) -> MidLine:
    """The middle line of a ring; both masks are boolean, `infield` is what it encloses."""
    to_infield = _distance(~infield)
    to_outside = _distance(road | infield)
    ahead = to_infield - to_outside  # negative near the infield, grows by 2 per pixel
    inner = (infield | (road & (ahead < 0))).astype(np.uint8)
    contours, _ = cv2.findContours(inner, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    points = max(contours, key=cv2.contourArea).reshape(-1, 2).astype(np.float32)
    smooth = cv2.GaussianBlur(ahead, (0, 0), 1.0)
    slope_x = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=1 / 8)
    slope_y = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=1 / 8)
    for _ in range(NEWTON_STEPS):
        gradient = np.column_stack((sample(slope_x, points), sample(slope_y, points)))
        steep = np.maximum((gradient**2).sum(axis=1), 0.5)
        step = gradient * (sample(smooth, points) / steep)[:, None]
        points = points - np.clip(step, -1, 1).astype(np.float32)
    # Both distances are to pixel centres, half a pixel beyond the road's edge.
    half_width = (sample(to_infield, points) + sample(to_outside, points) - 1) / 2
    return MidLine(points.astype(float), half_width.astype(float))


def sample(values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Values of a float32 image, interpolated at (n, 2) points x, y."""
    x, y = np.asarray(points, np.float32).T
    rows = [  # remap takes at most 32767 columns
        cv2.remap(values, x[i : i + 30000][None], y[i : i + 30000][None], cv2.INTER_LINEAR)[0]
        for i in range(0, len(x), 30000)
    ]
    return np.concatenate(rows)


def _distance(inside: np.ndarray) -> np.ndarray:
    """The distance of each pixel to the nearest one that is not inside, px."""
    return cv2.distanceTransform(inside.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)

"""The direction of the wall that each beam of a scan hit, from the ends of neighbouring beams."""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled

SPAN = 0.15        # m to either side in which a beam's neighbours are on its wall
LEAST = 3          # neighbours to either side that are used in any case, however far
STEEP = 5.0        # neighbours farther apart than this, in widths of a beam, are on two walls
NOISE = 0.05       # m; neighbours as near as this are always on one wall
ALONG = 0.002      # weight of a beam along a smooth wall; across it the weight is 1
SMOOTH, ROUND = 0.05, 0.25  # scatter across relative to along the wall: a wall, a corner or a post


@compiled("b1(f8[:,::1], f8[::1], f8, i8, i8)")
def _linked(ends: np.ndarray, ranges: np.ndarray, width: float, i: int, j: int) -> bool:
    """Whether two neighbours are on one wall."""
    apart = math.hypot(ends[i, 0] - ends[j, 0], ends[i, 1] - ends[j, 1])
    return apart < max(NOISE, STEEP * width * min(ranges[i], ranges[j]))


@compiled("f8[:,::1](f8[:,::1], f8[::1], f8)")
def holds(ends: np.ndarray, ranges: np.ndarray, width: float) -> np.ndarray:
    """How much each beam holds the robot, (N, 3): xx, xy, yy of a matrix in the frame of `ends`.

    Its value is 1 across the wall and ALONG along it; 1 in both directions at corners and posts.
    `ends` (N, 2) and `ranges` (N,), m, sorted by angle; `width`, rad, between neighbouring beams.
    """
    count = len(ends)
    found = np.empty((count, 3))
    for i in range(count):
        number, x, y, xx, xy, yy = 1, 0.0, 0.0, 0.0, 0.0, 0.0
        for direction in (-1, 1):
            last = i
            for k in range(1, count):
                j = (i + direction * k) % count
                dx, dy = ends[j, 0] - ends[i, 0], ends[j, 1] - ends[i, 1]
                if not _linked(ends, ranges, width, last, j) or (
                        k > LEAST and math.hypot(dx, dy) > SPAN):
                    break
                last = j
                number += 1
                x, y = x + dx, y + dy
                xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
        xx, xy, yy = xx - x * x / number, xy - x * y / number, yy - y * y / number
        middle, spread = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
        along = 1.0
        if number >= 3:
            share = (middle - spread) / (middle + spread)
            along = min(1.0, max(ALONG, (share - SMOOTH) / (ROUND - SMOOTH)))
        # The matrix is 1 - (1 - along) t t^T, where t is the wall's direction.
        turn = 0.5 * math.atan2(xy, 0.5 * (xx - yy))
        cos, sin = math.cos(turn), math.sin(turn)
        found[i, 0] = 1.0 - (1.0 - along) * cos * cos
        found[i, 1] = -(1.0 - along) * cos * sin
        found[i, 2] = 1.0 - (1.0 - along) * sin * sin
    return found

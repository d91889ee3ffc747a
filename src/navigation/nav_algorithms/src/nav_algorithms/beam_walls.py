"""What each beam of a scan says of the wall where it ended: which way the wall goes."""

from __future__ import annotations

import math

import numpy as np

from nav_algorithms.compiled import compiled

SPAN = 0.15        # m to either side in which a beam's neighbours are on its wall
LEAST = 3          # neighbours to either side that are looked at, however far
STEEP = 5.0        # neighbours farther apart than this, in widths of a beam, are on two walls
NOISE = 0.05       # m; neighbours that near are on one wall at any rate
ALONG = 0.002      # how much a beam holds along a smooth wall; across it 1
SMOOTH, ROUND = 0.05, 0.25  # scatter across as a share of that along: a wall, a corner or a post


@compiled("b1(f8[:,::1], f8[::1], f8, i8, i8)")
def _linked(ends: np.ndarray, ranges: np.ndarray, width: float, i: int, j: int) -> bool:
    """Whether two neighbours are on one wall."""
    apart = math.hypot(ends[i, 0] - ends[j, 0], ends[i, 1] - ends[j, 1])
    return apart < max(NOISE, STEEP * width * min(ranges[i], ranges[j]))


@compiled("f8[:,::1](f8[:,::1], f8[::1], f8)")
def holds(ends: np.ndarray, ranges: np.ndarray, width: float) -> np.ndarray:
    """How much each beam holds the robot, (N, 3): xx, xy, yy of a matrix in the frame of `ends`.

    Its value is 1 across the wall and ALONG along it; 1 both ways at corners and posts. `ends`
    (N, 2) and `ranges` (N,), m, in the order of their angles; `width`, rad, between two beams.
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
        # The matrix is 1 - (1 - along) t t^T, with t along the wall.
        turn = 0.5 * math.atan2(xy, 0.5 * (xx - yy))
        cos, sin = math.cos(turn), math.sin(turn)
        found[i, 0] = 1.0 - (1.0 - along) * cos * cos
        found[i, 1] = -(1.0 - along) * cos * sin
        found[i, 2] = 1.0 - (1.0 - along) * sin * sin
    return found

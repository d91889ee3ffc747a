"""Whether a road of some width keeps clear of itself."""

from __future__ import annotations

import math

import numpy as np

from racecar_description.track.centre_line import CentreLine

SPACING = 0.05  # m, between the points compared


def touching_place(line: CentreLine, width: float) -> tuple[float, float] | None:
    """x, y (m) where two stretches of a road this wide touch; None if none do."""
    apart, i, j, points = _least(line, width)
    return tuple((points[i] + points[j]) / 2) if apart < width else None


def widest_road(line: CentreLine, limit: float) -> float:
    """The largest width (m) up to `limit` at which the road does not touch itself."""
    width = limit
    for _ in range(20):
        apart = _least(line, width)[0]
        if apart >= width:
            break
        width = apart
    return width


def _least(line: CentreLine, width: float) -> tuple[float, int, int, np.ndarray]:
    """The least distance between stretches that are not neighbours along the line, and where.

    Two points within a half circle round the road's own edge count as neighbours.
    """
    points = line.points(SPACING)
    count = len(points)
    steps = np.abs(np.arange(count)[:, None] - np.arange(count)[None, :])
    along = np.minimum(steps, count - steps) * line.length / count
    apart = np.hypot(*(points[:, None, :] - points[None, :, :]).transpose(2, 0, 1))
    apart[along < math.pi / 2 * width + 2 * SPACING] = np.inf
    i, j = np.unravel_index(int(np.argmin(apart)), apart.shape)
    return float(apart[i, j]), int(i), int(j), points

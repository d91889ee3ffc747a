"""Column scan: each column's free road, from the bottom up to the first line pixel.

It ends at the left line in the columns left of the deepest one, and at the right line in those
right of it. Where a line runs along the columns, they say little about it.
"""

from __future__ import annotations

import numpy as np

from lane_keeping.lane import Marks, Plan, fit_side, make_lane, steer_by_error
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

SMOOTHING = 31  # columns; one free column between two spots is not road
LEAST_COLUMNS = 60  # a line in fewer runs along the columns, and its first pixels say little


def free_rows(mask: np.ndarray) -> np.ndarray:
    """(columns,) how many rows are free above the bottom, up to the first line pixel or the top."""
    upwards = mask[::-1] > 0
    return np.where(upwards.any(axis=0), upwards.argmax(axis=0), len(mask))


def line_rows(mask: np.ndarray, free: np.ndarray) -> np.ndarray:
    """(columns,) the row in the middle of the line that ends each column's free road."""
    upwards = mask[::-1] > 0
    above = np.arange(len(mask))[:, None] > free
    road_again = ~upwards & above
    end = np.where(road_again.any(axis=0), road_again.argmax(axis=0), len(mask))
    return len(mask) - 1 - (free + end - 1) / 2


def deepest(free: np.ndarray) -> int:
    """The column to which the free road deepens from the image's middle.

    Not simply the deepest one: outside the lane's lines, the road is free too.
    """
    smooth = np.convolve(np.pad(free, SMOOTHING // 2, "edge"), np.ones(SMOOTHING), "valid")
    column, last = len(free) // 2, len(free) - 1
    for step in (1, -1):
        while 0 < column < last and smooth[column + step] > smooth[column]:
            column += step
    level = np.flatnonzero(smooth < smooth[column])  # a plateau's middle, not its border
    begin = level[level < column].max(initial=-1) + 1
    end = level[level > column].min(initial=last + 1)
    return int(begin + end) // 2


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    free = free_rows(mask)
    split, rows = deepest(free), line_rows(mask, free)
    hit = np.flatnonzero((free < len(mask)) & (free > 0))  # 0: the line leaves at the bottom
    points = np.stack([hit, rows[hit]], axis=1)
    sides = [
        fit_side(part) if len(part) >= LEAST_COLUMNS else None
        for part in (points[hit < split], points[hit >= split])
    ]
    lane = make_lane(*sides, view, Marks(points=points[::4]))
    return steer_by_error(lane, view, settings)

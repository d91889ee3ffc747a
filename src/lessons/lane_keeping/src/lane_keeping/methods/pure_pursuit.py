"""Pure pursuit: the lane as a path in metres on the ground, and the arc to a goal on that path.

From the lane's middle, rows are searched to either side up to the first line pixel; those about
half a lane away on the ground count. Steering uses the distance ahead in metres, so that one
parameter works at any speed, unlike the law on the image's error.
"""

from __future__ import annotations

import numpy as np

from lane_keeping.lane import Lane, Marks, Plan, fit_side, make_lane, steer_by_pursuit
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

ROWS = 30  # searched
NEAREST, FARTHEST = 0.6, 1.6  # half lane widths between the middle and a line
FIRST = 0.2, 2.0  # the same for the first line found: the robot may be off the middle


def runs(row: np.ndarray) -> np.ndarray:
    """The middles of all runs of line pixels in one row of the mask, from left to right."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], row > 0, [0]])))
    return (edges[::2] + edges[1::2] - 1) / 2


def look_along(mask: np.ndarray, view: RoadView) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2) pixels of the left and of the right line, from the bottom row up."""
    middle, found, reach = mask.shape[1] / 2, ([], []), FIRST
    for row in np.linspace(len(mask) - 1, 0, ROWS).astype(int):
        lines, half = runs(mask[row]), view.lane_width_px(row) / 2
        if half <= 0:  # at or above the horizon
            break
        aside = (lines - middle) / half  # left negative
        left = lines[(-reach[1] < aside) & (aside < -reach[0])][-1:]
        right = lines[(reach[0] < aside) & (aside < reach[1])][:1]
        guesses = np.concatenate([left + half, right - half])
        if len(guesses):
            middle, reach = float(guesses.mean()), (NEAREST, FARTHEST)
        found[0].extend((column, row) for column in left)
        found[1].extend((column, row) for column in right)
    return tuple(np.array(points, float).reshape(-1, 2) for points in found)


def goal_on(lane: Lane, view: RoadView, distance: float) -> tuple[float, float]:
    """The centre line's point (ahead, left), m, at about this distance (m) from the axle."""
    rows = np.linspace(0, view.rows - 1, 60)
    path = view.to_ground(np.stack([np.polyval(lane.centre.curve, rows), rows], axis=1))
    best = np.abs(np.hypot(path[:, 0], path[:, 1]) - distance).argmin()
    return float(path[best, 0]), float(path[best, 1])


def plan(mask: np.ndarray, view: RoadView, settings: Settings) -> Plan | None:
    """See the package for the common signature."""
    left, right = look_along(mask, view)
    marks = Marks(points=np.concatenate([left, right]))
    lane = make_lane(fit_side(left), fit_side(right), view, marks)
    if lane is None:
        return None
    return steer_by_pursuit(lane, goal_on(lane, view, settings.pursuit_distance), view, settings)

"""A detected lane, and speed and turn rate for it: the tutorial's law, and pure pursuit.

A line is a second-order curve, and so is the centre line between two: (3,) coefficients of
column = a row^2 + b row + c, in pixels of the region of interest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings

LEFT, RIGHT = 1.0, -1.0
MIN_SPAN = 20  # rows that a line's pixels must span to show its direction
QUADRATIC_SPAN = 80  # rows needed to distinguish a bend from a slanted line
NARROWEST, WIDEST = 0.6, 1.7  # distance of two lines in lane widths; bends look wider


@dataclass(frozen=True)
class Side:
    """One line of the lane: its curve, and the range of rows (first, last) in which it was seen."""

    curve: np.ndarray
    rows: tuple[float, float]


@dataclass(frozen=True)
class Marks:
    """Where a method searched, for drawing: boxes (x0, y0, x1, y1) and points (x, y), in px."""

    boxes: tuple[tuple[int, int, int, int], ...] = ()
    points: np.ndarray | None = None


@dataclass(frozen=True)
class Lane:
    """The lines that were seen, at least one, the centre line, and the method's marks."""

    left: Side | None
    right: Side | None
    centre: Side
    marks: Marks = Marks()


def fit_side(points: np.ndarray) -> Side | None:
    """A curve through (n, 2) pixels (column, row); None if they do not show a direction."""
    if len(points) < 3:
        return None
    columns, rows = np.asarray(points, float).T
    first, last = rows.min(), rows.max()
    if last - first < MIN_SPAN:
        return None
    if last - first < QUADRATIC_SPAN:
        return Side(np.concatenate([[0.0], np.polyfit(rows, columns, 1)]), (first, last))
    return Side(np.polyfit(rows, columns, 2), (first, last))


def make_lane(
    left: Side | None, right: Side | None, view: RoadView, marks: Marks = Marks()
) -> Lane | None:
    """The lane between two lines, or beside one; None without lines.

    Two lines that are too close or too far apart cannot be a lane: the longer one is used.
    """
    if left is not None and right is not None and not _are_a_lane(left, right, view):
        longer = np.ptp(left.rows) >= np.ptp(right.rows)
        left, right = (left, None) if longer else (None, right)
    if left is None and right is None:
        return None
    if left is not None and right is not None:
        rows = (min(left.rows[0], right.rows[0]), max(left.rows[1], right.rows[1]))
        centre = Side((left.curve + right.curve) / 2, rows)
    elif left is not None:
        centre = beside(left, RIGHT, view)
    else:
        centre = beside(right, LEFT, view)
    return None if centre is None else Lane(left, right, centre, marks)


def beside(side: Side, towards: float, view: RoadView) -> Side | None:
    """The centre line half a lane beside a single line, measured perpendicular to it on the ground.

    towards: LEFT if the centre is to the left of the line, else RIGHT.
    """
    rows = np.linspace(*side.rows, 25)
    ground = view.to_ground(np.stack([np.polyval(side.curve, rows), rows], axis=1))
    along = np.gradient(ground, axis=0)
    along *= -1 / np.maximum(np.hypot(*along.T), 1e-9)[:, None]  # rows grow towards the robot
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)  # to the left of the direction ahead
    pixels = view.to_pixels(ground + towards * view.lane_width / 2 * normal)
    return fit_side(pixels[np.isfinite(pixels).all(axis=1)])


def _are_a_lane(left: Side, right: Side, view: RoadView) -> bool:
    """Whether the lines are about a lane's width apart where both were seen."""
    first, last = max(left.rows[0], right.rows[0]), min(left.rows[1], right.rows[1])
    rows = np.linspace(min(first, last), last, 5)
    apart = np.polyval(right.curve - left.curve, rows) / np.maximum(view.lane_width_px(rows), 1e-6)
    return bool(NARROWEST < np.median(apart) < WIDEST)


@dataclass(frozen=True)
class Plan:
    """The command for a lane, and the reasons."""

    lane: Lane
    target: tuple[float, float]  # px, the centre line's point to steer to
    error: float  # share of half the image's width, right positive
    curvature: float  # 1/px, of the centre line at the target
    speed: float  # m/s
    turn: float  # rad/s, left positive


def curvature_px(curve: np.ndarray, row: float) -> float:
    """Curvature in 1/px, never negative, of column(row)."""
    slope = 2 * curve[0] * row + curve[1]
    return float(abs(2 * curve[0]) / (1 + slope**2) ** 1.5)


def cruise(error: float, curvature: float, settings: Settings) -> float:
    """Speed in m/s: slower in bends, which show as curvature or as error."""
    bend = curvature > settings.bend_curvature or abs(error) > settings.bend_error
    return settings.bend_speed if bend else settings.straight_speed


def steer_by_error(lane: Lane | None, view: RoadView, settings: Settings) -> Plan | None:
    """The tutorial's law: turn in proportion to the centre line's offset at the look-ahead row."""
    if lane is None:
        return None
    row = settings.look_ahead * view.rows
    column = float(np.polyval(lane.centre.curve, row))
    error = column / (view.width / 2) - 1
    curvature = curvature_px(lane.centre.curve, row)
    turn = float(np.clip(-settings.steer_gain * error, -settings.max_turn, settings.max_turn))
    return Plan(lane, (column, row), error, curvature, cruise(error, curvature, settings), turn)


def steer_by_pursuit(
    lane: Lane | None, goal: tuple[float, float], view: RoadView, settings: Settings
) -> Plan | None:
    """Pure pursuit: the arc through a goal (ahead, left) in m on the ground."""
    if lane is None:
        return None
    ahead, left = goal
    column, row = view.to_pixels(np.array([goal]))[0]
    error = float(column) / (view.width / 2) - 1
    curvature = curvature_px(lane.centre.curve, float(row))
    speed = cruise(error, curvature, settings)
    turn = speed * 2 * left / (ahead**2 + left**2)
    turn = float(np.clip(turn, -settings.max_turn, settings.max_turn))
    return Plan(lane, (float(column), float(row)), error, curvature, speed, turn)

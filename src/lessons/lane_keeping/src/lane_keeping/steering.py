"""From a lane to speed and turn rate: the tutorial's law in pixels, and pure pursuit in metres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lane_keeping.lane import Lane
from lane_keeping.road_view import RoadView
from lane_keeping.settings import Settings


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

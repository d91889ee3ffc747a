"""Steering and speed from the points of a line: PID on the error ahead, slower before bends.

The camera sees no road nearer than just before the front wheels. The curvature from the rear axle
to there was seen a moment ago, and is remembered; only the distance driven since has to be known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from car_control.driving.pid import Pid, PidGains
from car_control.driving.speed_profile import SpeedLimits, speed_profile
from car_control.lane.line_finding import LaneSettings

FEWEST = 4  # points needed to fit a bend


@dataclass(frozen=True)
class Bend:
    """The line near one place, in the frame of its points."""

    s: float  # m along the line, from its first point
    x: float  # m
    y: float  # m
    heading: float  # rad
    curvature: float  # 1/m, left positive


def bends_along(points: np.ndarray, spacing: float, window: float) -> list[Bend]:
    """Bends at the first point and every `spacing` m; none for fewer than FEWEST points.

    points: (n, 2) m, in order. window: m of line to which each parabola is fitted, half of it on
    each side, if the line is that long.
    """
    if len(points) < FEWEST:
        return []
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    return [_fit(points, s, place, window) for place in np.arange(0.0, s[-1], spacing)]


def _fit(points: np.ndarray, s: np.ndarray, place: float, window: float) -> Bend:
    begin = max(0.0, min(place - window / 2, s[-1] - window))
    near = points[(s >= begin - 1e-9) & (s <= begin + window)]
    if len(near) < FEWEST:
        first = int(np.clip(np.searchsorted(s, place) - FEWEST // 2, 0, len(points) - FEWEST))
        near = points[first : first + FEWEST]
    middle = np.array([np.interp(place, s, points[:, k]) for k in (0, 1)])
    turned = math.atan2(*(near[-1] - near[0])[::-1])
    c, d = math.cos(turned), math.sin(turned)
    along, across = ((near - middle) @ np.array([[c, -d], [d, c]])).T
    c2, c1, c0 = np.polyfit(along, across, 2)
    x, y = middle + c0 * np.array((-d, c))
    # A parabola's curvature falls off from its vertex, a road's does not: use the vertex's.
    return Bend(place, float(x), float(y), turned + math.atan(c1), float(2 * c2))


STEP = 0.05  # m, integration step
LEAST = 0.01  # m between two entries, at least
BEHIND = 0.5  # m that are kept


class BendMemory:
    """Curvatures (1/m, left positive) at places ahead of the rear axle, in m along the line."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self._places: list[float] = []  # m from where the memory starts, ascending
        self._curvatures: list[float] = []
        self._driven = 0.0

    def drive(self, way: float) -> None:
        """The car has moved forward by `way` m."""
        self._driven += way
        while len(self._places) > 1 and self._places[1] < self._driven - BEHIND:
            del self._places[0], self._curvatures[0]

    def see(self, ahead: float, curvature: float) -> None:
        """The line has this curvature `ahead` m from here; older values beyond are dropped."""
        place = self._driven + ahead
        while self._places and self._places[-1] > place - LEAST:
            del self._places[-1], self._curvatures[-1]
        self._places.append(place)
        self._curvatures.append(curvature)

    def curvature(self, ahead: np.ndarray | float) -> np.ndarray:
        """The curvature at these places ahead; beyond the last known one, its value; else 0."""
        if not self._places:
            return np.zeros(np.shape(ahead))
        return np.interp(np.add(ahead, self._driven), self._places, self._curvatures)

    def shape(self, length: float) -> np.ndarray:
        """(n, 3) x, y (m) and heading (rad) of the line, as if the car stood on it."""
        way = np.arange(0.0, length + STEP, STEP)
        heading = np.concatenate([[0.0], np.cumsum(self.curvature(way[:-1] + STEP / 2)) * STEP])
        middle = (heading[1:] + heading[:-1]) / 2
        x = np.concatenate([[0.0], np.cumsum(np.cos(middle)) * STEP])
        y = np.concatenate([[0.0], np.cumsum(np.sin(middle)) * STEP])
        return np.stack([x, y, heading], axis=1)


SPACING = 0.2  # m between the places whose bends are computed
WINDOW = 0.6  # m of line to which one bend is fitted
SPEED_TIME = 0.1  # s, about the time that the wheels need to reach a new speed
LONGEST_PERIOD = 0.2  # s; after a longer pause the state is outdated
BLINK = 0.3  # s without a line during which the car keeps its last command

WAITING, FOLLOWING, SEARCHING, STOPPED = "waiting", "following", "searching", "stopped"


@dataclass(frozen=True)
class LaneCommand:
    """Speed (m/s), steering angle (rad), and which of the four states the driver is in."""

    speed: float
    steering_angle: float
    state: str


class LaneDriver:
    """Call `drive` once per image; times are the images' stamps, in s."""

    def __init__(self, settings: LaneSettings):
        self.settings = settings  # may be changed at any time
        self.memory, self.pid = BendMemory(), Pid(PidGains(0.0))
        self.state = WAITING
        self.error = 0.0  # m from the line ahead of the car; positive: the line is to the left
        self.lateral = 0.0  # m to the left, where the line last entered the image
        self._last = LaneCommand(0.0, 0.0, WAITING)
        self._last_time: float | None = None
        self._seen_time = 0.0
        self._speed = 0.0  # m/s, estimated speed of the wheels

    def drive(self, time: float, seen: np.ndarray) -> LaneCommand:
        """The command for an image at this time with these points of the line (n, 2)."""
        period = self._period(time)
        self._speed += (self._last.speed - self._speed) * (1 - math.exp(-period / SPEED_TIME))
        self.memory.drive(self._speed * period)
        bends = bends_along(seen, SPACING, WINDOW)
        if bends:
            self._last = self._follow(bends, period)
            self._seen_time = time
        else:
            self._last = self._without_line(time)
        self.state = self._last.state
        return self._last

    def halt(self) -> None:
        """The car was stopped, for whatever reason: reset the state."""
        self.memory.forget()
        self.pid.reset()
        self._last = LaneCommand(0.0, 0.0, self.state)
        self._last_time, self._speed = None, 0.0

    def _period(self, time: float) -> float:
        """Seconds since the last image; 0 after a pause or when the clock was set back."""
        if self._last_time is None or not 0 <= time - self._last_time <= LONGEST_PERIOD:
            self.halt()
            self._seen_time = self._last_time = time
        period, self._last_time = time - self._last_time, time
        return period

    def _follow(self, bends: list[Bend], period: float) -> LaneCommand:
        settings, near = self.settings, bends[0]
        self.lateral = near.y
        self.memory.see(near.x, near.curvature)
        self.error = self._error(near)
        limit = settings.max_steering_angle
        self.pid.gains = PidGains(
            settings.kp, settings.ki, settings.kd, limit, settings.derivative_time
        )
        # The line's curvature where the car will be when the wheels have turned.
        bend = float(self.memory.curvature(self._speed * settings.latency))
        angle = math.atan(settings.wheelbase * bend) + self.pid.compute(self.error, period)
        speed = self._planned_speed(bends, period)
        return LaneCommand(speed, max(-limit, min(limit, angle)), FOLLOWING)

    def _error(self, near: Bend) -> float:
        """m between the line's nearest visible point and where it would be with the car on it."""
        shape = self.memory.shape(near.x)
        y, heading = (np.interp(near.x, shape[:, 0], shape[:, k]) for k in (1, 2))
        return float((near.y - y) * math.cos(heading))

    def _planned_speed(self, bends: list[Bend], period: float) -> float:
        settings = self.settings
        if settings.max_speed == 0:
            return 0.0
        limits = SpeedLimits(
            settings.max_speed, settings.lateral_acceleration, settings.acceleration,
            settings.braking,
        )
        before = np.arange(0.0, bends[0].x, SPACING)
        curvature = np.append(self.memory.curvature(before), [bend.curvature for bend in bends])
        speed = speed_profile(curvature, np.full(len(curvature) - 1, SPACING), limits)[0]
        # Beyond the last place nothing is known: be slow enough there to search.
        sight = SPACING * (len(curvature) - 1)
        speed = min(speed, math.sqrt(settings.search_speed**2 + 2 * settings.braking * sight))
        speed /= 1 + abs(self.error) / settings.error_slowdown
        faster = self._last.speed + settings.acceleration * period
        return max(min(speed, faster), min(settings.search_speed, settings.max_speed))

    def _without_line(self, time: float) -> LaneCommand:
        """Continue for a moment, then turn slowly to where the line was; finally stop."""
        settings, lost = self.settings, time - self._seen_time
        if self.state in (WAITING, STOPPED):
            return LaneCommand(0.0, 0.0, self.state)
        slow = min(settings.search_speed, settings.max_speed)
        if self.state == FOLLOWING and lost < BLINK:
            speed = max(slow, self._last.speed / 2)
            return LaneCommand(speed, self._last.steering_angle, FOLLOWING)
        self.memory.forget()
        self.pid.reset()
        if lost > settings.search_time:
            return LaneCommand(0.0, 0.0, STOPPED)
        angle = math.copysign(settings.max_steering_angle, self.lateral)
        return LaneCommand(slow, angle, SEARCHING)

"""Where a car is by its own wheels alone: the rear ones say how far, the front ones which way.

Errors add up, as with every odometry; here mostly from wheels that slip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from car_control.driving.ackermann import (
    CarGeometry,
    HingeAngles,
    angle_from_hinges,
    curvature_from_angle,
)


@dataclass(frozen=True)
class Motion:
    """Pose of the rear axle's middle since the start, m and rad, and its speed, m/s and rad/s."""

    x: float
    y: float
    yaw: float
    speed: float
    turn_rate: float


class DeadReckoning:
    """Adds up small arcs."""

    def __init__(self, car: CarGeometry):
        self.motion = Motion(0.0, 0.0, 0.0, 0.0, 0.0)
        self._car = car
        self._last: tuple[float, float, float] | None = None  # time, bend, rear wheels' mean angle

    def add(self, time: float, left_rear: float, right_rear: float,
            hinges: HingeAngles) -> Motion:
        """Angles, rad, of rear wheels (they count on beyond a turn) and hinges at `time`, s.

        A time that is not later than the last one begins anew from the same pose: the clock was set
        back, and what the wheels did meanwhile is not known.
        """
        turned = (left_rear + right_rear) / 2
        bend = curvature_from_angle(self._car, angle_from_hinges(self._car, hinges))
        last, self._last = self._last, (time, bend, turned)
        if last is None or time <= last[0]:
            self.motion = Motion(self.motion.x, self.motion.y, self.motion.yaw, 0.0, 0.0)
            return self.motion
        way = (turned - last[2]) * self._car.wheel_radius
        turn = way * (bend + last[1]) / 2
        heading = self.motion.yaw + turn / 2  # of the chord
        chord = way * (math.sin(turn / 2) / (turn / 2) if turn else 1.0)
        period = time - last[0]
        self.motion = Motion(self.motion.x + chord * math.cos(heading),
                             self.motion.y + chord * math.sin(heading),
                             math.remainder(self.motion.yaw + turn, math.tau),
                             way / period, turn / period)
        return self.motion

"""Dead reckoning: distance from the rear wheels, direction from the steering hinges.

Errors accumulate, as in every odometry; here mostly from wheel slip.
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
    """Pose of the rear axle's middle relative to the start, m and rad, and speed, m/s and rad/s."""

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
        """Angles, rad, of rear wheels (they continue beyond a full turn) and hinges at `time`, s.

        If `time` is not later than the last one, the clock was set back: it starts again from the
        same pose, because the motion in between is unknown.
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

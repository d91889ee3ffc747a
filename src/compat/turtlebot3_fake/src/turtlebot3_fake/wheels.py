"""A robot of two wheels that turn at once as commanded: its pose, by integration."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

WHEEL_RADIUS = 0.033  # m
SEPARATIONS = {"burger": 0.160, "waffle": 0.287, "waffle_pi": 0.287}  # m
COMMAND_TIMEOUT = 1.0  # s without a command, and the robot stands


@dataclass(frozen=True)
class Wheels:
    """Pose in the odometry frame (m, rad), angles (rad) and speeds (rad/s) of left and right."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0
    angles: tuple[float, float] = (0.0, 0.0)
    speeds: tuple[float, float] = (0.0, 0.0)


def separation(model: str) -> float:
    """In m; an unknown model gets the burger's."""
    return SEPARATIONS.get(model, SEPARATIONS["burger"])


def wheel_speeds(linear: float, angular: float, apart: float) -> tuple[float, float]:
    """rad/s left and right, for m/s forward and rad/s to the left."""
    return tuple((linear + side * angular * apart / 2) / WHEEL_RADIUS for side in (-1, 1))


def roll(wheels: Wheels, speeds: tuple[float, float], apart: float, dt: float) -> Wheels:
    """The robot after dt seconds at these wheel speeds (rad/s)."""
    left, right = (speed * dt for speed in speeds)
    way, turn = WHEEL_RADIUS * (left + right) / 2, WHEEL_RADIUS * (right - left) / apart
    heading = wheels.yaw + turn / 2  # of the chord: exact to second order
    return replace(wheels, x=wheels.x + way * math.cos(heading),
                   y=wheels.y + way * math.sin(heading),
                   yaw=math.remainder(wheels.yaw + turn, math.tau),
                   angles=(wheels.angles[0] + left, wheels.angles[1] + right), speeds=speeds)


def velocity(wheels: Wheels, apart: float) -> tuple[float, float]:
    """m/s forward and rad/s to the left, from the wheels' speeds."""
    left, right = wheels.speeds
    return WHEEL_RADIUS * (left + right) / 2, WHEEL_RADIUS * (right - left) / apart

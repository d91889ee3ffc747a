"""Ackermann steering: angle and speed of each wheel so that none scrubs in a bend.

All wheels roll around one point on the line of the rear axle. The steering hinges are above the
wheel centres. Angles are in rad, counter-clockwise (left) positive; wheel speeds in rad/s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CarGeometry:
    """Lengths in m; a track is the distance between the centres of an axle's two wheels."""

    wheelbase: float
    front_track: float
    rear_track: float
    wheel_radius: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0:
                raise ValueError(f"{name} must be more than 0 m, is {value!r}")


@dataclass(frozen=True)
class HingeAngles:
    """Angles of the two front wheels, rad."""

    left: float
    right: float


@dataclass(frozen=True)
class WheelSpeeds:
    """Speeds of the four wheels, rad/s, forward positive."""

    left_rear: float
    right_rear: float
    left_front: float
    right_front: float


def curvature_from_angle(car: CarGeometry, steering_angle: float) -> float:
    """Curvature (1/m) of the rear axle's path for the bicycle model's steering angle."""
    return math.tan(steering_angle) / car.wheelbase


def angle_from_curvature(car: CarGeometry, curvature: float) -> float:
    """The bicycle model's steering angle, rad, for this curvature (1/m)."""
    return math.atan(curvature * car.wheelbase)


def sharpest_angle(car: CarGeometry) -> float:
    """The steering angle (rad) that turns the inner front wheel by 90 degrees: the limit."""
    return math.atan(2 * car.wheelbase / max(car.front_track, car.rear_track))


def hinge_angles(car: CarGeometry, steering_angle: float) -> HingeAngles:
    """Both hinge angles for the steering angle; ValueError at `sharpest_angle` and beyond."""
    bend = _checked_curvature(car, steering_angle)
    sideways = bend * car.front_track / 2
    return HingeAngles(
        left=math.atan(bend * car.wheelbase / (1 - sideways)),
        right=math.atan(bend * car.wheelbase / (1 + sideways)),
    )


def wheel_speeds(car: CarGeometry, speed: float, steering_angle: float) -> WheelSpeeds:
    """All wheel speeds for the speed (m/s) of the rear axle's middle; ValueError as above."""
    bend = _checked_curvature(car, steering_angle)
    turn = speed / car.wheel_radius
    rear, front = bend * car.rear_track / 2, bend * car.front_track / 2
    ahead = bend * car.wheelbase
    return WheelSpeeds(
        left_rear=turn * (1 - rear),
        right_rear=turn * (1 + rear),
        left_front=turn * math.hypot(1 - front, ahead),
        right_front=turn * math.hypot(1 + front, ahead),
    )


def angle_from_hinges(car: CarGeometry, hinges: HingeAngles) -> float:
    """The steering angle for two hinge angles, from the mean of the curvatures they imply."""
    half = car.front_track / 2
    left, right = math.tan(hinges.left), math.tan(hinges.right)
    bends = left / (car.wheelbase + left * half), right / (car.wheelbase - right * half)
    return angle_from_curvature(car, sum(bends) / 2)


def _checked_curvature(car: CarGeometry, angle: float) -> float:
    if not abs(angle) < sharpest_angle(car):
        raise ValueError(
            f"a steering angle of {angle:.3f} rad cannot be driven:"
            f" it must lie within +-{sharpest_angle(car):.3f} rad"
        )
    return curvature_from_angle(car, angle)

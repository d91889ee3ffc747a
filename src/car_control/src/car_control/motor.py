"""Commands for the car's six joint controllers, and when it has to stop; no ROS."""

from __future__ import annotations

import math
from dataclasses import dataclass

from node_basics.settings import explained, number

from car_control.driving.ackermann import CarGeometry, hinge_angles, sharpest_angle, wheel_speeds

PAGE_WHEEL_GAIN = 8.0  # rad/s of all wheels per unit of linear.x, as in the tutorial
WHEELS = ("left_rear", "right_rear", "left_front", "right_front")
HINGES = ("left", "right")
WHEEL_CONTROLLERS = tuple(f"{wheel}_wheel_velocity_controller" for wheel in WHEELS)
HINGE_CONTROLLERS = tuple(f"{hinge}_steering_hinge_position_controller" for hinge in HINGES)


@dataclass(frozen=True)
class MotorSettings:
    """Settings of the node motor_control; SI units."""

    namespace: str = explained("of the joint controllers")
    ackermann: bool = explained("an angle and a speed for each wheel; false: the tutorial's law")
    rate_hz: float = number(0, 200, "Hz at which the last command is repeated; 0: never")
    timeout: float = number(0.02, 10, "s without a command after which the car stops")
    max_speed: float = number(0, 20, "m/s")
    max_steering_angle: float = number(0, 1.2, "rad, front wheel of the bicycle model")
    max_acceleration: float = number(0, 100, "m/s^2 when speeding up; 0: no limit")
    wheelbase: float = number(0.01, 10, "m from axle to axle")
    front_track: float = number(0.01, 10, "m between the centres of the front wheels")
    rear_track: float = number(0.01, 10, "m between the centres of the rear wheels")
    wheel_radius: float = number(0.001, 2, "m")

    def __post_init__(self) -> None:
        sharpest = sharpest_angle(self.geometry)
        if not self.max_steering_angle < sharpest:
            raise ValueError(
                f"'max_steering_angle' must be less than {sharpest:.3f} rad for this wheelbase"
                f" and these tracks, not {self.max_steering_angle:g}"
            )

    @property
    def geometry(self) -> CarGeometry:
        return CarGeometry(self.wheelbase, self.front_track, self.rear_track, self.wheel_radius)


@dataclass(frozen=True)
class DriveCommand:
    """Speed in m/s (in the tutorial's law: its own unit) and steering angle in rad."""

    speed: float
    steering_angle: float


class Motor:
    """Keeps the last command and decides what to do now; all times in s of one clock."""

    def __init__(self, settings: MotorSettings):
        self.settings = settings
        self.emergency = False  # while true the car stands, whatever is commanded
        self._command: DriveCommand | None = None
        self._taken = 0.0
        self._last = DriveCommand(0.0, 0.0)
        self._last_time = 0.0

    def take(self, command: DriveCommand, now: float) -> None:
        """A new command; one that is not finite raises ValueError and is ignored."""
        if not (math.isfinite(command.speed) and math.isfinite(command.steering_angle)):
            raise ValueError(
                f"speed {command.speed!r}, steering angle {command.steering_angle!r}:"
                " both must be finite numbers"
            )
        self._command, self._taken = command, now

    def forget(self) -> None:
        """Drop the command: its sender has ended."""
        self._command = None

    def drive(self, now: float) -> DriveCommand:
        """The command for now. A stop is immediate and keeps the steering angle."""
        if not 0 <= now - self._taken <= self.settings.timeout:
            self._command = None  # also if the clock was set back: such a command is outdated
        if self.emergency or self._command is None:
            self._last = DriveCommand(0.0, self._last.steering_angle)
        else:
            self._last = self._limited(self._command, now - self._last_time)
        self._last_time = now
        return self._last

    def _limited(self, command: DriveCommand, period: float) -> DriveCommand:
        settings = self.settings
        speed = _clamp(command.speed, settings.max_speed)
        if settings.max_acceleration > 0:
            # From the current speed, but not from one in the opposite direction: only speeding up
            # is limited, slowing down is not.
            so_far = self._last.speed if self._last.speed * speed > 0 else 0.0
            reach = abs(so_far) + settings.max_acceleration * max(period, 0.0)
            speed = _clamp(speed, reach)
        return DriveCommand(speed, _clamp(command.steering_angle, settings.max_steering_angle))


def controller_commands(settings: MotorSettings, drive: DriveCommand) -> dict[str, float]:
    """Commands by controller name: rad/s for the four wheels, rad for the two hinges."""
    if not settings.ackermann:
        wheels = dict.fromkeys(WHEEL_CONTROLLERS, PAGE_WHEEL_GAIN * drive.speed)
        return wheels | dict.fromkeys(HINGE_CONTROLLERS, drive.steering_angle)
    speeds = wheel_speeds(settings.geometry, drive.speed, drive.steering_angle)
    angles = hinge_angles(settings.geometry, drive.steering_angle)
    turns = [getattr(speeds, wheel) for wheel in WHEELS]
    turned = [getattr(angles, hinge) for hinge in HINGES]
    return dict(zip(WHEEL_CONTROLLERS + HINGE_CONTROLLERS, turns + turned))


def _clamp(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))

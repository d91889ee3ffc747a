"""Four wheels, each driven and steered, without slip: all turn about one point."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from bullet_sim.control.controllers.commands import TimedCommand
from bullet_sim.control.controllers.mobile_base import (
    BaseOptions,
    Claim,
    MobileBase,
    read_distance,
    read_wheel_radius,
)
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.errors import check_lengths
from bullet_sim.formats.urdf.facts import RobotFacts

# m/s; below this speed the wheels stop (four_wheel_steering_controller.cpp, updateCommand)
CRAWL = 1e-3
STEEPEST = math.radians(89.9)  # the tangent of a larger steering angle of an axle is not usable


@dataclass(frozen=True)
class FourWheelGeometry:
    """Lengths in m; the base's origin is in the middle of the four wheels."""

    track: float
    wheelbase: float
    wheel_radius: float

    def __post_init__(self):
        check_lengths(self, "track", "wheelbase", "wheel_radius")

    def places(self) -> tuple[tuple[float, float], ...]:
        """The wheels' positions from the middle: front left, front right, rear left, rear right."""
        x, y = self.wheelbase / 2, self.track / 2
        return (x, y), (x, -y), (-x, y), (-x, -y)


class FourWheelSteering(MobileBase):
    """Takes a twist, or speed and the angles of both axles; the later one counts.

    Wheels and steering joints in the order of `FourWheelGeometry.places`.
    """

    def __init__(self, wheels: Sequence[CommandHandle], steering: Sequence[CommandHandle],
                 geometry: FourWheelGeometry, options: BaseOptions):
        super().__init__(options)
        self._wheels, self._steering = tuple(wheels), tuple(steering)
        self._geometry = geometry
        self._axles = TimedCommand(3, options.command_timeout)
        self._now = 0.0
        self._last_motion = 0.0

    @classmethod
    def from_parameters(cls, p: ControllerParameters, robot: RobotFacts, claim: Claim
                        ) -> FourWheelSteering:
        """Of four_wheel_steering_controller.

        PluginError for a parameter that is wrong, SimulationError for a length that is not above 0.
        """
        wheels, steering = (
            [name for axle in ("front", "rear")
             for name in p.pair(f"{axle}_{kind}", "an axle has two, left and right")]
            for kind in ("wheel", "steering"))
        return cls(
            [claim("velocity", name) for name in wheels],
            [claim("position", name) for name in steering],
            FourWheelGeometry(read_distance(p, robot, "track", steering[0], steering[1]),
                              read_distance(p, robot, "wheel_base", wheels[0], wheels[2]),
                              read_wheel_radius(p, robot, wheels[0])),
            BaseOptions.from_parameters(p))

    def command_axles(self, time: float, forward: float, front: float, rear: float) -> None:
        """Command the speed (m/s) and the steering angles (rad) of the front and the rear axle."""
        self._command.clear()
        front, rear = (max(-STEEPEST, min(STEEPEST, angle)) for angle in (front, rear))
        self._axles.give(time, forward, front, rear)

    def command(self, time: float, forward: float, turning: float) -> None:
        """Command the speed (m/s) and the yaw rate (rad/s)."""
        self._axles.clear()
        super().command(time, forward, turning)

    def start(self, time: float) -> None:
        """Stand still, with straight wheels."""
        self._axles.clear()
        self._now = self._last_motion = time
        super().start(time)

    def update(self, time: float, period: float) -> None:
        """Run one control period."""
        self._now = time
        super().update(time, period)

    def _wanted(self, time: float) -> tuple[float, float]:
        forward, front, rear = self._axles.at(time)
        if self._axles.time > self._command.time:
            return forward, self._yaw_rate(forward, math.tan(front), math.tan(rear))
        return self._command.at(time)

    def _yaw_rate(self, forward: float, front: float, rear: float) -> float:
        """The yaw rate from a speed and the tangents of both axles' angles."""
        return forward * (front - rear) / self._geometry.wheelbase

    def _drive(self, forward: float, turning: float) -> None:
        _, front_angle, rear_angle = self._axles.at(self._now)
        if self._axles.time > self._command.time:
            front, rear = math.tan(front_angle), math.tan(rear_angle)
        elif abs(forward) > CRAWL:
            front = turning * self._geometry.wheelbase / (2 * forward)
            rear = -front
        else:
            front = rear = 0.0
        commands = wheel_commands(self._geometry, forward, front, rear)
        for wheel, steering, (speed, angle) in zip(
                self._wheels, self._steering, commands, strict=True):
            wheel.command, steering.command = speed, angle

    def _moved(self) -> tuple[float, float, float]:
        elapsed, self._last_motion = self._now - self._last_motion, self._now
        speeds = [wheel.joint.velocity * self._geometry.wheel_radius for wheel in self._wheels]
        angles = [steering.joint.position for steering in self._steering]
        twist = measured_twist(self._geometry, speeds, angles)
        return tuple(rate * elapsed for rate in twist)


def wheel_commands(geometry: FourWheelGeometry, forward: float, front: float,
                   rear: float) -> list[tuple[float, float]]:
    """(rad/s, rad) of each wheel, from a speed (m/s) and the tangents of both axles' angles.

    A body turning at w moves at (v - w y, v tan) at a wheel at (x, y), and the wheel points in
    that direction. If the turning point is between the wheels, all are at a right angle.
    """
    slope = (front - rear) / geometry.wheelbase  # yaw rate per m/s
    beside = abs(slope) * geometry.track / 2 < 1.0
    commands = []
    for x, y in geometry.places():
        across = front if x > 0 else rear
        along = 1.0 - slope * y
        angle = math.atan(across / along) if beside else math.copysign(math.pi / 2, across)
        speed = forward * math.hypot(along, across) / geometry.wheel_radius
        commands.append((speed if abs(forward) > CRAWL else 0.0, angle))
    return commands


def measured_twist(geometry: FourWheelGeometry, speeds: Sequence[float],
                   angles: Sequence[float]) -> tuple[float, float, float]:
    """Forward and leftward speed (m/s) and yaw rate (rad/s) that best fit four wheels.

    Least squares over the wheels' velocity vectors; the wheels are symmetric about the middle, so
    the sums separate.
    """
    forward = leftward = moment = arms = 0.0
    for (x, y), speed, angle in zip(geometry.places(), speeds, angles, strict=True):
        vx, vy = speed * math.cos(angle), speed * math.sin(angle)
        forward, leftward = forward + vx / 4, leftward + vy / 4
        moment, arms = moment + x * vy - y * vx, arms + x * x + y * y
    return forward, leftward, moment / arms

"""The common part of mobile bases: a command with a time-out, limits, and odometry."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from bullet_sim.control.controllers.commands import TimedCommand
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.pose import Pose, quaternion_from_rpy
from bullet_sim.sensors.odometry import OdometryReading

Claim = Callable[[str, str], CommandHandle]  # of an interface and a joint

UNBOUNDED = (float("-inf"), float("inf"))


@dataclass(frozen=True)
class SpeedLimits:
    """(minimum, maximum) of a speed in m/s or rad/s and of its first two derivatives."""

    velocity: tuple[float, float] = UNBOUNDED
    acceleration: tuple[float, float] = UNBOUNDED  # per s
    jerk: tuple[float, float] = UNBOUNDED  # per s^2

    @classmethod
    def from_parameters(cls, parameters: ControllerParameters, group: str) -> SpeedLimits:
        """The limits of one speed, from a group of parameters such as `linear/x`."""
        def bounds(quantity: str) -> tuple[float, float]:
            if not parameters.flag(f"{group}/has_{quantity}_limits", False):
                return UNBOUNDED
            greatest = parameters.number(f"{group}/max_{quantity}", 0.0)
            return parameters.number(f"{group}/min_{quantity}", -greatest), greatest

        return cls(bounds("velocity"), bounds("acceleration"), bounds("jerk"))


UNLIMITED = SpeedLimits()


class SpeedLimiter:
    """Remembers the last two speeds that it returned; call `limit` once per control period."""

    def __init__(self, limits: SpeedLimits):
        self._limits = limits
        self.restart()

    def restart(self) -> None:
        """Start from standstill."""
        self._last = self._before = 0.0

    def limit(self, wanted: float, period: float) -> float:
        """The allowed speed nearest to `wanted`, `period` s after the last one."""
        limits, last = self._limits, self._last
        # SpeedLimiter::limit_jerk (diff_drive_controller's speed_limiter.cpp) gives jerk twice its
        # nominal effect, so the limits in published configurations mean that.
        bend = 2.0 * period * period
        speed = _within(wanted, limits.jerk, bend, last + (last - self._before))
        speed = _within(speed, limits.acceleration, period, last)
        speed = _within(speed, limits.velocity)
        self._before, self._last = self._last, speed
        return speed


def _within(value: float, bounds: tuple[float, float], scale: float = 1.0,
            centre: float = 0.0) -> float:
    """`value` clamped to centre + scale * bounds."""
    if bounds == UNBOUNDED:
        return value
    least, greatest = bounds
    return max(centre + least * scale, min(centre + greatest * scale, value))


# s; no speed is computed from a shorter time (diff_drive_controller's odometry.cpp, update)
SHORTEST = 1e-4
STRAIGHT = 1e-6  # rad; a smaller turn counts as straight


class PlanarOdometry:
    """Starts at zero, at any pose in the world; speeds are averaged over `window` updates."""

    def __init__(self, window: int):
        self._speeds: deque[tuple[float, float, float]] = deque(maxlen=max(1, window))
        self._x = self._y = self._yaw = 0.0
        self._time = 0.0

    def restart(self, time: float) -> None:
        """Continue from the same pose; time counts from here, and speeds start at zero."""
        self._time = time
        self._speeds.clear()

    def move(self, time: float, forward: float, leftward: float, turn: float) -> None:
        """Add the motion since the last call, in m and rad, in the frame of the pose before."""
        elapsed = time - self._time
        if elapsed < 0:  # time was reset, and joints with it
            self.restart(time)
            return
        self._advance(forward, leftward, turn)
        if elapsed < SHORTEST:
            return
        self._time = time
        self._speeds.append((forward / elapsed, leftward / elapsed, turn / elapsed))

    def update_open_loop(self, time: float, forward: float, yaw_rate: float) -> None:
        """Open loop: use these speeds (m/s, rad/s) as the motion since the last call."""
        elapsed = max(0.0, time - self._time)
        self._time = time
        self._speeds.clear()
        self._speeds.append((forward, 0.0, yaw_rate))
        self._advance(forward * elapsed, 0.0, yaw_rate * elapsed)

    def sample(self) -> OdometryReading:
        """The current estimate."""
        pose = Pose((self._x, self._y, 0.0), quaternion_from_rpy(0.0, 0.0, self._yaw))
        count = max(1, len(self._speeds))
        forward, leftward, yaw_rate = (
            sum(speed[i] for speed in self._speeds) / count for i in range(3))
        return OdometryReading(self._time, pose, forward, leftward, yaw_rate)

    def _advance(self, forward: float, leftward: float, turn: float) -> None:
        """Move along the arc of constant twist: the exponential map of SE(2)."""
        if abs(turn) < STRAIGHT:
            along, across = 1.0, turn / 2
        else:
            along, across = math.sin(turn) / turn, (1.0 - math.cos(turn)) / turn
        dx, dy = along * forward - across * leftward, across * forward + along * leftward
        cos, sin = math.cos(self._yaw), math.sin(self._yaw)
        self._x += cos * dx - sin * dy
        self._y += sin * dx + cos * dy
        self._yaw += turn


@dataclass(frozen=True)
class BaseOptions:
    """Defaults of diff_drive_controller.cpp, DiffDriveController::init."""

    forward_limits: SpeedLimits = UNLIMITED  # m/s
    turning_limits: SpeedLimits = UNLIMITED  # rad/s; rad for a steering angle
    command_timeout: float = 0.5  # s; after that the base brakes
    velocity_window: int = 10  # control periods over which the published speeds are averaged
    open_loop: bool = False  # odometry follows the commands instead of the wheels

    @classmethod
    def from_parameters(cls, parameters: ControllerParameters) -> BaseOptions:
        """Read the parameters that all bases share."""
        return cls(
            SpeedLimits.from_parameters(parameters, "linear/x"),
            SpeedLimits.from_parameters(parameters, "angular/z"),
            parameters.number("cmd_vel_timeout", 0.5),
            round(parameters.number("velocity_rolling_window_size", 10)),
            parameters.flag("open_loop", False))


def read_distance(p: ControllerParameters, robot: RobotFacts, name: str, first: str, second: str,
                  axis: int | None = None) -> float:
    """A parameter, else the distance of two joints, m; with `axis` (0: x, 1: y) along that axis."""
    if p.has(name):
        return p.number(name)
    one, other = robot.pose(first).position, robot.pose(second).position
    return math.dist(one, other) if axis is None else abs(one[axis] - other[axis])


def read_wheel_radius(p: ControllerParameters, robot: RobotFacts, joint: str) -> float:
    """The parameter `wheel_radius`, else the radius of the wheel on a joint, m."""
    return p.number("wheel_radius") if p.has("wheel_radius") else robot.wheel_radius(joint)


class MobileBase(ABC):
    """Turns (forward, turning) into wheel commands each control period; keeps the odometry."""

    def __init__(self, options: BaseOptions):
        self._options = options
        self._forward_limiter = SpeedLimiter(options.forward_limits)
        self._turning_limiter = SpeedLimiter(options.turning_limits)
        self._command = TimedCommand(2, options.command_timeout)
        self.odometry = PlanarOdometry(options.velocity_window)
        self.wanted = (0.0, 0.0)  # before limiting
        self.limited = (0.0, 0.0)

    @classmethod
    @abstractmethod
    def from_parameters(cls, p: ControllerParameters, robot: RobotFacts, claim: Claim
                        ) -> MobileBase:
        """From a controller's parameters; lengths that they lack are those of the URDF.

        PluginError for a parameter that is missing or of the wrong type, SimulationError for a
        joint that cannot be claimed, or a length of 0.
        """

    def command(self, time: float, forward: float, turning: float) -> None:
        """Command from now (s, simulated) on: m/s, and the drive's unit of turning."""
        self._command.give(time, forward, turning)

    def start(self, time: float) -> None:
        """Brake; odometry keeps its pose."""
        self._command.clear()
        self._forward_limiter.restart()
        self._turning_limiter.restart()
        self.wanted = self.limited = (0.0, 0.0)
        self.odometry.restart(time)
        self._moved()
        self.stop()

    def update(self, time: float, period: float) -> None:
        """Run one control period: update the odometry, then the commands."""
        if self._options.open_loop:
            self.odometry.update_open_loop(time, *self._twist(*self.limited))
        else:
            self.odometry.move(time, *self._moved())
        self.wanted = self._wanted(time)
        self.limited = (self._forward_limiter.limit(self.wanted[0], period),
                        self._turning_limiter.limit(self.wanted[1], period))
        self._drive(*self.limited)

    def stop(self) -> None:
        """Brake at once."""
        self._drive(0.0, 0.0)

    def _wanted(self, time: float) -> tuple[float, float]:
        return self._command.at(time)

    @abstractmethod
    def _moved(self) -> tuple[float, float, float]:
        """Forward and leftward distance (m) and turn (rad) of the wheels since the last call."""

    def _twist(self, forward: float, turning: float) -> tuple[float, float]:
        """Speed (m/s) and yaw rate (rad/s) for such a command."""
        return forward, turning

    @abstractmethod
    def _drive(self, forward: float, turning: float) -> None:
        """Set the joints' commands."""

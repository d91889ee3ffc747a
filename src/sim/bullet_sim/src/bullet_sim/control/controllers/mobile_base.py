"""The common part of mobile bases: a command with a time-out, limits, and odometry."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from bullet_sim.control.controllers.commands import TimedCommand
from bullet_sim.control.controllers.planar_odometry import PlanarOdometry
from bullet_sim.control.controllers.speed_limiter import UNLIMITED, SpeedLimiter, SpeedLimits


@dataclass(frozen=True)
class BaseOptions:
    """Defaults of diff_drive_controller.cpp, DiffDriveController::init."""

    forward_limits: SpeedLimits = UNLIMITED  # m/s
    turning_limits: SpeedLimits = UNLIMITED  # rad/s; rad for a steering angle
    command_timeout: float = 0.5  # s; after that the base brakes
    velocity_window: int = 10  # control periods over which the published speeds are averaged
    open_loop: bool = False  # odometry follows the commands instead of the wheels


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

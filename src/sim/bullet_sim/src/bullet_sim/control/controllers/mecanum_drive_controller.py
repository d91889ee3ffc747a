"""Mecanum drive: four wheels whose rollers are at 45 degrees to the axle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bullet_sim.control.controllers.commands import TimedCommand
from bullet_sim.control.controllers.mobile_base import (
    UNLIMITED,
    BaseOptions,
    Claim,
    MobileBase,
    SpeedLimiter,
    SpeedLimits,
    read_distance,
    read_wheel_radius,
)
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.errors import check_lengths
from bullet_sim.formats.urdf.facts import RobotFacts

# Signs of leftward speed and yaw rate in a wheel's rim speed: front left, back left, back right,
# front right. Seen from above, the rollers' axes form an X; those on the ground a diamond.
SIGNS = ((-1, -1), (1, -1), (-1, 1), (1, 1))
CORNERS = ("front_left", "back_left", "back_right", "front_right")


@dataclass(frozen=True)
class MecanumGeometry:
    """Lengths in m."""

    reach: float  # half the wheelbase plus half the track
    wheel_radius: float

    def __post_init__(self):
        check_lengths(self, "reach", "wheel_radius")


class MecanumDrive(MobileBase):
    """`turning` is the yaw rate (rad/s); odometry always comes from the wheels."""

    def __init__(self, wheels: Sequence[CommandHandle], geometry: MecanumGeometry,
                 options: BaseOptions, sideways_limits: SpeedLimits = UNLIMITED):
        """Wheels in the order of `SIGNS`; `sideways_limits` are for the leftward speed (m/s)."""
        super().__init__(replace(options, open_loop=False))
        self.wheels, self._geometry = tuple(wheels), geometry
        self._sideways = TimedCommand(1, options.command_timeout)
        self._sideways_limiter = SpeedLimiter(sideways_limits)
        self._leftward = 0.0
        self._travelled = [0.0] * len(self.wheels)

    @classmethod
    def from_parameters(cls, p: ControllerParameters, robot: RobotFacts, claim: Claim
                        ) -> MecanumDrive:
        """Of mecanum_drive_controller.

        PluginError for a parameter that is wrong, SimulationError for a length that is not above 0.
        """
        wheels = [_joint(p, corner) for corner in CORNERS]
        handles = [claim("velocity", name) for name in wheels]
        return cls(handles, _geometry(p, robot, wheels), BaseOptions.from_parameters(p),
                   SpeedLimits.from_parameters(p, "linear/y"))

    def command(self, time: float, forward: float, turning: float, leftward: float = 0.0) -> None:
        """Command from now (s, simulated) on: m/s, rad/s, m/s."""
        self._sideways.give(time, leftward)
        super().command(time, forward, turning)

    def start(self, time: float) -> None:
        """Brake; odometry keeps its pose."""
        self._sideways.clear()
        self._sideways_limiter.restart()
        super().start(time)

    def update(self, time: float, period: float) -> None:
        """Run one control period."""
        self._leftward = self._sideways_limiter.limit(self._sideways.at(time)[0], period)
        super().update(time, period)

    def stop(self) -> None:
        """Brake at once."""
        self._leftward = 0.0
        super().stop()

    def _drive(self, forward: float, turning: float) -> None:
        g = self._geometry
        for wheel, (sideways, around) in zip(self.wheels, SIGNS, strict=True):
            rim = forward + sideways * self._leftward + around * g.reach * turning
            wheel.command = rim / g.wheel_radius

    def _moved(self) -> tuple[float, float, float]:
        g, before = self._geometry, self._travelled
        self._travelled = [wheel.joint.position for wheel in self.wheels]
        ways = [(now - then) * g.wheel_radius / 4
                for now, then in zip(self._travelled, before, strict=True)]
        leftward = sum(way * sideways for way, (sideways, _) in zip(ways, SIGNS, strict=True))
        turned = sum(way * around for way, (_, around) in zip(ways, SIGNS, strict=True))
        return sum(ways), leftward, turned / g.reach


def _joint(p: ControllerParameters, corner: str) -> str:
    """The joint of a wheel; some forks call it rear, not back."""
    other = f"{corner.replace('back', 'rear')}_wheel_joint"
    return p.text(other) if p.has(other) else p.text(f"{corner}_wheel_joint")


def _geometry(p: ControllerParameters, robot: RobotFacts, wheels: list[str]) -> MecanumGeometry:
    """From parameters, else the URDF (mecanum_drive_controller.cpp, setWheelParamsFromUrdf)."""
    length = read_distance(p, robot, "wheel_separation_x", wheels[0], wheels[1], axis=0)
    width = read_distance(p, robot, "wheel_separation_y", wheels[0], wheels[3], axis=1)
    realigned = p.flag("use_realigned_roller_joints", False)
    touching = (realigned and robot.joints_on(wheels[0])) or wheels
    return MecanumGeometry((length + width) / 2, read_wheel_radius(p, robot, touching[0]))

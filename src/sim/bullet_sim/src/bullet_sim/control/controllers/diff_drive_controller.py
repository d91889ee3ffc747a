"""Differential drive: wheels on two sides, turned by the difference of their speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import (
    BaseOptions,
    Claim,
    MobileBase,
    read_distance,
    read_wheel_radius,
)
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.errors import PluginError, check_lengths
from bullet_sim.formats.urdf.facts import RobotFacts


@dataclass(frozen=True)
class DiffDriveGeometry:
    """Lengths in m."""

    wheel_separation: float
    left_radius: float
    right_radius: float

    def __post_init__(self):
        check_lengths(self, "wheel_separation", "left_radius", "right_radius")


class DiffDriveLaw(MobileBase):
    """`turning` is the yaw rate (rad/s). All wheels of a side get the same velocity."""

    def __init__(self, left: Sequence[CommandHandle], right: Sequence[CommandHandle],
                 geometry: DiffDriveGeometry, options: BaseOptions):
        super().__init__(options)
        self.left, self.right = tuple(left), tuple(right)
        self._measured = self.geometry = geometry
        self.multipliers: Mapping[str, float] = {}
        self._travelled = (0.0, 0.0)

    @classmethod
    def from_parameters(cls, p: ControllerParameters, robot: RobotFacts,
                        claim: Claim) -> DiffDriveLaw:
        """Of diff_drive_controller; the first wheel of each side stands for the others.

        PluginError for a parameter that is wrong, SimulationError for a length that is not above 0.
        """
        left, right = p.texts("left_wheel"), p.texts("right_wheel")
        if len(left) != len(right):
            raise PluginError(f"left_wheel has {len(left)} joints and right_wheel {len(right)}; "
                              "they must be as many")
        separation = read_distance(p, robot, "wheel_separation", left[0], right[0])
        radius = read_wheel_radius(p, robot, left[0])
        drive = cls([claim("velocity", name) for name in left],
                    [claim("velocity", name) for name in right],
                    DiffDriveGeometry(separation, radius, radius), BaseOptions.from_parameters(p))
        both = p.number("wheel_radius_multiplier", 1.0)
        drive.multiply({
            "left_wheel_radius_multiplier": p.number("left_wheel_radius_multiplier", both),
            "right_wheel_radius_multiplier": p.number("right_wheel_radius_multiplier", both),
            "wheel_separation_multiplier": p.number("wheel_separation_multiplier", 1.0)})
        return drive

    def multiply(self, multipliers: Mapping[str, float]) -> None:
        """Set the factors on the lengths, by their parameters' names; at any time.

        SimulationError for one that is not above 0.
        """
        self.multipliers, g = multipliers, self._measured
        self.geometry = DiffDriveGeometry(
            g.wheel_separation * multipliers["wheel_separation_multiplier"],
            g.left_radius * multipliers["left_wheel_radius_multiplier"],
            g.right_radius * multipliers["right_wheel_radius_multiplier"])

    def wheel_speeds(self, forward: float, turning: float) -> tuple[float, float]:
        """Speeds of the left and of the right wheels, rad/s."""
        g = self.geometry
        half = turning * g.wheel_separation / 2
        return (forward - half) / g.left_radius, (forward + half) / g.right_radius

    def _drive(self, forward: float, turning: float) -> None:
        left, right = self.wheel_speeds(forward, turning)
        for handle in self.left:
            handle.command = left
        for handle in self.right:
            handle.command = right

    def _moved(self) -> tuple[float, float, float]:
        before, g = self._travelled, self.geometry
        self._travelled = _mean_angle(self.left), _mean_angle(self.right)
        left = (self._travelled[0] - before[0]) * g.left_radius
        right = (self._travelled[1] - before[1]) * g.right_radius
        return (left + right) / 2, 0.0, (right - left) / g.wheel_separation


def _mean_angle(wheels: Sequence[CommandHandle]) -> float:
    return sum(wheel.joint.position for wheel in wheels) / len(wheels)

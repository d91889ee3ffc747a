"""Differential drive: wheels on two sides, turned by the difference of their speeds."""

from collections.abc import Sequence
from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import BaseOptions, MobileBase
from bullet_sim.control.handles import CommandHandle
from bullet_sim.errors import check_lengths


@dataclass(frozen=True)
class DiffDriveGeometry:
    """Lengths in m, with multipliers applied."""

    wheel_separation: float
    left_radius: float
    right_radius: float

    def __post_init__(self):
        check_lengths(self, "wheel_separation", "left_radius", "right_radius")


class DiffDrive(MobileBase):
    """`turning` is the yaw rate (rad/s). All wheels of a side get the same velocity."""

    def __init__(self, left: Sequence[CommandHandle], right: Sequence[CommandHandle],
                 geometry: DiffDriveGeometry, options: BaseOptions):
        super().__init__(options)
        self.left, self.right = tuple(left), tuple(right)
        self.geometry = geometry  # may be replaced at any time
        self._travelled = (0.0, 0.0)

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

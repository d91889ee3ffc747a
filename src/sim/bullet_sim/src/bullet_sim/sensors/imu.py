"""Inertial measurements of a link: orientation, rate of turn, acceleration."""

from __future__ import annotations

from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.pose import Quaternion, Vector3
from bullet_sim.world import World


@dataclass(frozen=True)
class ImuReading:
    """Everything in world axes; `linear_acceleration` is without gravity."""

    time: float  # s, simulated
    orientation: Quaternion  # link in the world
    angular_velocity: Vector3  # rad/s
    linear_acceleration: Vector3  # m/s^2, change of the link's velocity since the last sample


class Imu:
    """Ideal: noise, offsets and axes are the business of who publishes."""

    def __init__(self, world: World, link: Link):
        self._world = world
        self._link = link
        self.restart()

    def restart(self) -> None:
        """Forget the last velocity."""
        self._last: tuple[float, Vector3] | None = None

    def sample(self) -> ImuReading:
        """Read the link; the first acceleration is zero."""
        time, twist = self._world.time, self._link.twist
        acceleration = (0.0, 0.0, 0.0)
        if self._last is not None and time > self._last[0]:
            elapsed = time - self._last[0]
            acceleration = tuple(
                (now - before) / elapsed
                for now, before in zip(twist.linear, self._last[1], strict=True)
            )
        self._last = (time, twist.linear)
        return ImuReading(time, self._link.pose.orientation, twist.angular, acceleration)

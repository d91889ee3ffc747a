"""The true motion of a link in world axes: orientation, angular velocity, acceleration."""

from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.pose import Quaternion, Vector3
from bullet_sim.world import World


@dataclass(frozen=True)
class LinkMotionReading:
    """Of the link's origin, in world axes, without gravity and noise; not an IMU's reading."""

    time: float  # s, simulated
    orientation: Quaternion  # link in the world
    world_angular_velocity: Vector3  # rad/s
    world_acceleration: Vector3  # m/s^2, mean since the last sample


class LinkMotion:
    """Samples a link; IMU plugins rotate the readings into their axes and add noise."""

    def __init__(self, world: World, link: Link):
        self._world = world
        self._link = link
        self.restart()

    def restart(self) -> None:
        """Forget the last velocity."""
        self._last: tuple[float, Vector3] | None = None

    def sample(self) -> LinkMotionReading:
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
        return LinkMotionReading(time, self._link.pose.orientation, twist.angular, acceleration)

"""Net force and torque on a link, by Newton and Euler from the change of its momentum."""

import numpy as np

from bullet_sim.link import Link
from bullet_sim.pose import rotation_matrix, symmetric_matrix
from bullet_sim.twist import shifted_twist
from bullet_sim.world import World


class NetForce:
    """World axes, torque about the centre of mass; means since the last sample."""

    def __init__(self, world: World, link: Link):
        self._world, self._link = world, link
        self.restart()

    def restart(self) -> None:
        """Forget the last momentum."""
        self._last: tuple[float, np.ndarray] | None = None

    def sample(self) -> np.ndarray:
        """(6,) force in N and torque in N m; zeros at first."""
        now, momentum = self._world.time, self._momentum()
        rate = np.zeros(6)
        if self._last is not None and now > self._last[0]:
            rate = (momentum - self._last[1]) / (now - self._last[0])
        self._last = (now, momentum)
        return rate

    def _momentum(self) -> np.ndarray:
        """(6,) linear, kg m/s, and angular about the centre of mass, kg m^2/s."""
        inertial, frame = self._link.description.inertial, self._link.pose
        centre = frame * inertial.pose
        twist = shifted_twist(self._link.twist, frame.position, centre.position)
        turn = rotation_matrix(centre.orientation)
        tensor = turn @ symmetric_matrix(inertial.inertia) @ turn.T
        return np.concatenate([inertial.mass * np.array(twist.linear),
                               tensor @ np.array(twist.angular)])

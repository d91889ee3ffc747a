"""A winch that holds a link in the air, raises or lowers it, and releases it once."""

import math

from bullet_sim.errors import SimulationError
from bullet_sim.link import Link
from bullet_sim.pose import Pose, Vector3
from bullet_sim.world import World


class Harness:
    """Call `update` at every step."""

    def __init__(self, world: World, link: Link, axis: Vector3):
        """`axis`, in the world, is the direction of the winch at a positive speed.

        SimulationError if it is zero.
        """
        length = math.hypot(*axis)
        if length == 0.0:
            raise SimulationError("the harness has a joint without axis: it is 0 0 0")
        self._world = world
        self._axis = tuple(part / length for part in axis)
        self._speed = 0.0
        self._hook = link.attach()

    def command(self, speed: float) -> None:
        """Set the speed along the axis, m/s; held until the next command."""
        self._speed = speed

    def detach(self) -> None:
        """Release the link; it cannot be attached again."""
        self._speed = 0.0
        self._hook.release()

    def update(self) -> None:
        """Move on by one step."""
        if self._speed:
            step = self._speed * self._world.timestep
            self._hook.shift(Pose(tuple(part * step for part in self._axis)))

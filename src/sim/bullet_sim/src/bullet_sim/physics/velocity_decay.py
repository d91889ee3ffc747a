"""`<velocity_decay>`: a link loses a part of its velocity in every step (ODE manual, Damping).

The engine's own damping is the same for all links of a body and grows with the squared speed.
"""

import math

from bullet_sim.physics.body_links import BodyLinks
from bullet_sim.physics.client import EngineBody
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Vector3, conjugate, rotate

SLOWEST = 0.01  # m/s and rad/s below which nothing is lost: ODE's default thresholds


class VelocityDecay:
    """The velocity decay of one body; `apply` before each step."""

    def __init__(self, engine: EngineBody, links: BodyLinks):
        self._engine, self._motion = engine, links
        self._links = [
            (link.name, min(link.linear_damping, 1.0), min(link.angular_damping, 1.0))
            for link in engine.tree.links if link.linear_damping or link.angular_damping
            if not engine.tree.fixed or link.parent is not None]

    def __bool__(self) -> bool:
        return bool(self._links)

    def apply(self) -> None:
        """Apply forces and torques that remove that part in the next step."""
        step = self._engine.client.timestep
        for name, linear, angular in self._links:
            index = self._motion.index[name]
            com, velocity, rate = self._motion.com_motion(index)
            mass, _, moments = self._engine.dynamics(index)[:3]
            if math.hypot(*velocity) > SLOWEST:
                self._push(pybullet.applyExternalForce, index,
                           [-linear * mass / step * v for v in velocity],
                           com.position)
            if math.hypot(*rate) > SLOWEST:
                own = rotate(conjugate(com.orientation), rate)
                torque = [-angular / step * i * w for i, w in zip(moments, own, strict=True)]
                self._push(pybullet.applyExternalTorque, index, rotate(com.orientation, torque))

    def _push(self, function, index: int, vector: Vector3, *where: Vector3) -> None:
        self._engine.change_without_waking(function, index, vector, *where, pybullet.WORLD_FRAME)

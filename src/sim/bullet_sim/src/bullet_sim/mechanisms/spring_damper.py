"""A spring and a critical damper pull a link to a wanted pose."""

import math

from bullet_sim.link import Link, gravity_compensation
from bullet_sim.pose import Pose, Quaternion, Vector3, conjugate, multiply
from bullet_sim.world import World


class SpringDamper:
    """Formulas and default gains of gazebo_ros_hand_of_god.cpp; call `update` at every step.

    The forces are those of an implicit step, so that a light link does not oscillate wildly; for
    heavy ones they equal the explicit formula's.
    """

    def __init__(self, world: World, link: Link, stiffness: float = 200.0,
                 angular_stiffness: float = 200.0):
        """Stiffnesses in N/m and N m/rad."""
        self._world, self._link = world, link
        inertial = link.description.inertial
        ixx, _, _, iyy, _, izz = inertial.inertia
        self._mass = max(inertial.mass, 1e-6)
        self._least_inertia = max(min(ixx, iyy, izz), 1e-9)
        self._stiffness, self._angular_stiffness = stiffness, angular_stiffness
        self._damping = 2 * math.sqrt(stiffness * self._mass)  # N s/m
        self._angular_damping = 2 * math.sqrt(angular_stiffness * max(ixx, 0.0))  # N m s/rad

    def update(self, wanted: Pose | None) -> None:
        """Pull towards a pose in the world; None: only keep the link from falling."""
        link = self._link
        force = torque = (0.0, 0.0, 0.0)
        if wanted is not None:
            pose, twist = link.pose, link.twist
            gap = [w - p for w, p in zip(wanted.position, pose.position, strict=True)]
            turn = multiply(wanted.orientation, conjugate(pose.orientation))
            force = self._pull(gap, twist.linear, self._stiffness, self._damping, self._mass)
            torque = self._pull(rotation_vector(turn), twist.angular, self._angular_stiffness,
                                self._angular_damping, self._least_inertia)
        if link.description.gravity:
            up = gravity_compensation(link.description, self._world.description.gravity)
            force = tuple(f + u for f, u in zip(force, up, strict=True))
        if any(force) or any(torque):
            link.apply_force(force, torque)

    def _pull(self, gap, rate, stiffness: float, damping: float, inertia: float) -> Vector3:
        step = self._world.timestep
        slowed = 1 + (damping * step + stiffness * step * step) / inertia
        return tuple((stiffness * (g - r * step) - damping * r) / slowed
                     for g, r in zip(gap, rate, strict=True))


def rotation_vector(q: Quaternion) -> Vector3:
    """Axis times angle (rad, at most pi) of a unit quaternion."""
    x, y, z, w = q if q[3] >= 0 else tuple(-part for part in q)
    sine = math.sqrt(x * x + y * y + z * z)
    if sine < 1e-12:
        return (0.0, 0.0, 0.0)
    scale = 2 * math.atan2(sine, w) / sine
    return (x * scale, y * scale, z * scale)

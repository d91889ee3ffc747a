"""A link in the world: pose, twist, and forces on it."""

from __future__ import annotations

from typing import Protocol

from bullet_sim.description import LinkDescription
from bullet_sim.physics.body import Body
from bullet_sim.physics.weld import Weld
from bullet_sim.pose import Pose, Vector3
from bullet_sim.twist import Twist


class LinkOwner(Protocol):
    """What links, and drives by a link, need of their model (`bullet_sim.model.Model`)."""

    name: str
    pose: Pose
    twist: Twist

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of each link in the world, by name; read once per step."""
        ...


class Link:
    """A link's description and its current pose in the world."""

    def __init__(self, model: LinkOwner, description: LinkDescription, body: Body):
        self.model = model
        self.description = description
        self.name = description.name
        self.scoped_name = f"{model.name}::{description.name}"
        self.body = body

    @property
    def pose(self) -> Pose:
        """Link frame in the world."""
        return self.model.link_states()[self.name][0]

    @property
    def twist(self) -> Twist:
        """Velocity of the link frame's origin, world axes."""
        return self.model.link_states()[self.name][1]

    def attach(self, other: Link | None = None) -> Weld:
        """Weld it at its current pose to another model's link or the world, until released."""
        if other is None:
            return Weld(self.body, self.name)
        return Weld(self.body, self.name, other.body, other.name)

    def apply_force(self, force: Vector3, torque: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        self.body.links.apply_force(self.name, force, torque)

    def apply_steady_force(self, force: Vector3) -> None:
        """Force (N) at the centre of mass, applied in every step, world axes."""
        self.body.links.apply_steady_force(self.name, force)


def gravity_compensation(link: LinkDescription, gravity: Vector3) -> Vector3:
    """The force that makes a link with `<gravity>` off weightless, N."""
    return tuple(-link.inertial.mass * g for g in gravity)

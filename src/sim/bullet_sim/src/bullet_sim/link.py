"""A link in the world: where it is, how it moves, and what pulls at it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from bullet_sim.description import Inertial, LinkDescription
from bullet_sim.joint_projection import put_in_joint
from bullet_sim.physics.body import Body
from bullet_sim.physics.inertia import check_inertial
from bullet_sim.physics.weld import Weld
from bullet_sim.pose import Pose, Vector3
from bullet_sim.twist import Twist, twist_difference

if TYPE_CHECKING:
    from bullet_sim.model import Model


class Link:
    """A link's description and where it is now, in the world."""

    def __init__(self, model: Model, description: LinkDescription, body: Body):
        self.model = model
        self.description = description
        self.name = description.name
        self.scoped_name = f"{model.name}::{description.name}"
        self._body = body

    @property
    def pose(self) -> Pose:
        """Link frame in the world."""
        return self.model.link_states()[self.name][0]

    @property
    def twist(self) -> Twist:
        """Velocity of the link frame's origin, world axes."""
        return self.model.link_states()[self.name][1]

    def move(self, pose: Pose, twist: Twist) -> None:
        """Put it there, with that velocity (world axes), and all that joints hold it to.

        Joints keep their positions and rates. Of what is held to the world, the link's own joint
        alone moves, as far as it can.
        """
        if self._body.tree.held and not self.model.static:
            put_in_joint(self, self._body, pose, twist)
            return
        self.model.move_body(self._body, pose * self.pose.inverse())
        if not self._body.tree.held:
            self._body.add_twist(twist_difference(twist, self.twist), pose.position)
            self.model.forget()

    def change(self, inertial: Inertial, gravity: bool) -> None:
        """Other mass, centre of mass and inertia, and whether gravity pulls at it.

        SimulationError, and nothing changes, where no body is like that.
        """
        check_inertial(inertial)
        if not self.model.static:
            self._body.change_inertial(self.name, inertial)
            self.model.forget()
        self.description = replace(self.description, inertial=inertial, gravity=gravity)
        self.model.note_weightless()

    def attach(self, other: Link | None = None) -> Weld:
        """Hold it where it is now, on another model's link or in the world, until released."""
        if other is None:
            return Weld(self._body, self.name)
        return Weld(self._body, self.name, other._body, other.name)

    def apply_force(self, force: Vector3, torque: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        self._body.apply_force(self.name, force, torque)

    def apply_steady_force(self, force: Vector3) -> None:
        """Force (N) at the centre of mass that acts in every step, world axes."""
        self._body.apply_steady_force(self.name, force)


def gravity_compensation(link: LinkDescription, gravity: Vector3) -> Vector3:
    """Force that makes a link with `<gravity>` off weightless, N."""
    return tuple(-link.inertial.mass * g for g in gravity)

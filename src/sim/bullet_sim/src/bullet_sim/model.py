"""A model in the world: links and joints by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from bullet_sim.description import JointDescription, LinkDescription, ModelDescription
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.physics.assembly import WORLD, assemble
from bullet_sim.physics.body import STILL, Body, Twist, gravity_compensation
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.joint_group import JointGroup
from bullet_sim.pose import Pose, Vector3, conjugate, rotate


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

    def apply_force(self, force: Vector3, torque: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        self._body.apply_force(self.name, force, torque)


class Joint:
    """A joint that can move; positions in rad or m."""

    def __init__(self, description: JointDescription, body: Body, touched: Callable[[], None]):
        self.description = description
        self.name = description.name
        self._body = body
        self._touched = touched

    @property
    def position(self) -> float:
        """Angle or travel from the described pose."""
        return self._body.joint_state(self.name)[0]

    @property
    def velocity(self) -> float:
        """Rate of `position`."""
        return self._body.joint_state(self.name)[1]

    def reset(self, position: float, velocity: float = 0.0) -> None:
        """Put the joint there at once."""
        self._body.reset_joint(self.name, position, velocity)
        self._touched()

    def drive_velocity(self, velocity: float, effort: float) -> None:
        """Hold a rate with at most `effort` (N m or N), until told otherwise."""
        self._body.drive_velocity(self.name, velocity, effort)

    def drive_effort(self, effort: float) -> None:
        """Effort (N m or N) during the next step."""
        self._body.drive_effort(self.name, effort)

    def release(self) -> None:
        """Let it turn freely, but for its own friction."""
        self._body.release(self.name)


class Model:
    """A spawned description. Everything is in world coordinates unless a name says otherwise."""

    def __init__(self, name: str, description: ModelDescription, pose: Pose,
                 client: PhysicsClient):
        self.name = name
        self.description = description
        self.static = description.static
        self.initial_pose = pose
        self.bodies: list[Body] = []
        try:
            for tree in assemble(description):
                self.bodies.append(Body(client, tree, pose))
        except Exception:
            self.remove()  # what was made before the failure
            raise
        self._set_pose = pose  # of a model without links
        self._states: dict[str, tuple[Pose, Twist]] | None = None
        owner = {link.described: body for body in self.bodies for link in body.tree.links}
        self.links = {
            link.name: Link(self, link, owner[link.name]) for link in description.links
        }
        self.joints = {
            joint: Joint(body.joint_description(joint), body, self.forget)
            for body in self.bodies for joint in body.joint_names()
        }
        self._weightless = [] if self.static else [
            link for link in self.links.values() if not link.description.gravity]

    # --- state

    def forget(self) -> None:
        """What was read of the engine is out of date."""
        self._states = None

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of each link, read from the engine once a step."""
        if self._states is None:
            self._states = {}
            for body in self.bodies:
                self._states.update(body.link_states())
            self._states.pop(WORLD, None)
        return self._states

    @property
    def pose(self) -> Pose:
        """Model frame: it stays where the first link has it."""
        if not self.links or self.static:
            return self._set_pose
        first = self.description.links[0]
        return self.link_states()[first.name][0] * first.pose.inverse()

    @property
    def twist(self) -> Twist:
        """Velocity of the model frame's origin, world axes."""
        if not self.links or self.static:
            return STILL
        first = self.description.links[0]
        pose, twist = self.link_states()[first.name]
        return shifted_twist(twist, pose.position, self.pose.position)

    def set_pose(self, pose: Pose) -> None:
        """Move the model as a whole; joints keep their positions."""
        change = pose * self.pose.inverse()
        for body in self.bodies:
            body.set_base_frame(change * body.base_frame())
        self._set_pose = pose
        self.forget()

    def set_twist(self, twist: Twist) -> None:
        """Move as a rigid whole whose model frame has that twist; joints stop turning."""
        for joint in self.joints.values():
            joint.reset(joint.position)
        for body in self.bodies:
            if not body.tree.fixed:
                body.set_twist(twist, self.pose.position)
        self.forget()

    def reset(self) -> None:
        """Back to the pose it was spawned at, joints at zero, everything still."""
        for joint in self.joints.values():
            joint.reset(0.0)
        for body in self.bodies:
            body.set_base_frame(self.initial_pose * body.base_pose_model)
        self._set_pose = self.initial_pose
        self.forget()
        self.set_twist(STILL)

    # --- for the world

    def before_step(self, gravity: Vector3) -> None:
        """Forces that act every step; gravity in m/s^2."""
        for link in self._weightless:
            link.apply_force(gravity_compensation(link.description, gravity))

    def link(self, name: str) -> Link:
        """The link, or the one that took it in when fixed joints were lumped."""
        name = self.description.lumped.get(name, (name, None))[0]
        if name not in self.links:
            raise UnknownName(f"link of model {self.name}", name, self.links)
        return self.links[name]

    def joint(self, name: str) -> Joint:
        """The joint of that name."""
        held = [joint for joint in self.description.joints if joint.name == name]
        if name not in self.joints and held:
            raise SimulationError(f"joint {name!r} of model {self.name} is of type "
                                  f"{held[0].type}, which is held fixed")
        if name not in self.joints:
            raise UnknownName(f"joint of model {self.name}", name, self.joints)
        return self.joints[name]

    def joint_groups(self, names: Sequence[str]) -> list[JointGroup]:
        """The joints of these names, to be read and driven together: a group for each body."""
        for name in names:
            self.joint(name)
        groups = [body.joint_group(names) for body in self.bodies]
        return [group for group in groups if group.names]

    def remove(self) -> None:
        """Take its bodies out of the engine."""
        for body in self.bodies:
            body.remove()


def shifted_twist(twist: Twist, at: Vector3, to: Vector3) -> Twist:
    """The same rigid motion, seen at another point."""
    ax, ay, az = twist.angular
    x, y, z = (t - a for t, a in zip(to, at, strict=True))
    linear = twist.linear
    return Twist(
        (linear[0] + ay * z - az * y, linear[1] + az * x - ax * z, linear[2] + ax * y - ay * x),
        twist.angular,
    )


def twist_in(pose: Pose, twist: Twist) -> Twist:
    """World-axes twist, turned into the axes of `pose`."""
    back = conjugate(pose.orientation)
    return Twist(rotate(back, twist.linear), rotate(back, twist.angular))

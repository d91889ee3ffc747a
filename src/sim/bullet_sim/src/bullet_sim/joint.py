"""Joints of a model: driven by the engine, passive, or closing a loop."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

from bullet_sim.description import JointDescription
from bullet_sim.link import Link
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.axes import TRAVEL
from bullet_sim.physics.body import Body
from bullet_sim.physics.urdf_text import NO_LIMIT
from bullet_sim.pose import Pose, Vector3, conjugate, multiply, rotate
from bullet_sim.twist import add, cross, dot, negative


class BodyJoint:
    """A joint of the description that is part of a body."""

    second_axis: "Joint | None" = None  # of a universal or revolute2 joint

    def __init__(self, description: JointDescription, body: Body | None):
        self.description = description
        self.name = description.name
        self._body = body

    def reaction(self) -> tuple[Vector3, Vector3]:
        """Force (N) and torque (N m) of the child on the joint, in the child link's frame."""
        return joint_reaction(self._body, self._body.joints.carried_by(self.name))


class Joint(BodyJoint):
    """A joint that can move; positions in rad or m."""

    def __init__(self, description: JointDescription, body: Body, touched: Callable[[], None]):
        super().__init__(description, body)
        self._touched = touched

    @property
    def position(self) -> float:
        """Angle or travel from the described pose."""
        return self._body.joints.state(self.name)[0]

    @property
    def velocity(self) -> float:
        """Rate of `position`."""
        return self._body.joints.state(self.name)[1]

    def reset(self, position: float, velocity: float = 0.0) -> None:
        """Set the joint's position at once; a screw also travels as it turns."""
        self._body.joints.reset(self.name, position, velocity)
        if self.name + TRAVEL in self._body.joints.index:
            pitch = -self.description.thread_pitch
            self._body.joints.reset(self.name + TRAVEL, position / pitch, velocity / pitch)
        self._touched()

    def drive_velocity(self, velocity: float, effort: float) -> None:
        """Hold a velocity with at most `effort` (N m or N), until the next command."""
        self._body.joints.drive_velocity(self.name, velocity, effort)

    def drive_effort(self, effort: float) -> None:
        """Apply an effort (N m or N) during the next step, within the joint's limits.

        Cut as by Gazebo's Joint::CheckAndTruncateForce (physics/Joint.cc).
        """
        self._body.joints.drive_effort(self.name, self._within_limit(effort))

    def add_effort(self, effort: float) -> None:
        """Add an effort (N m or N) to the drive's during the next step; cut to the limit."""
        self._body.joints.add_effort(self.name, self._within_limit(effort))

    def _within_limit(self, effort: float) -> float:
        """Cut to the effort limit; none that would accelerate it beyond the velocity limit."""
        limit, fastest = self.description.effort, self.description.velocity
        if fastest >= 0 and effort:
            rate = self.velocity
            if abs(rate) > fastest and rate * effort > 0:
                return 0.0
        return effort if limit < 0 else max(-limit, min(limit, effort))

    @property
    def motor(self) -> tuple[float, float]:
        """The motor's velocity, and its maximum effort."""
        return self._body.joints.motor(self.name)

    def change(self, lower: float, upper: float, damping: float) -> None:
        """Change limits, rad or m (none if `lower` is above `upper`), and damping (N m s/rad)."""
        stops = {"lower": lower, "upper": upper, "damping": damping}
        kind = self.description.type
        if kind == "continuous" and min(abs(lower), abs(upper)) < NO_LIMIT:
            kind = "revolute"
        self.description = replace(self.description, type=kind, **stops)
        self._body.change_joint(self.name, type=kind, **stops)
        self._touched()


class PassiveJoint(BodyJoint):
    """A joint that is not driven: fixed, or a ball joint, which has no single angle."""

    position = velocity = 0.0  # as there is no single angle
    motor = (0.0, 0.0)  # has no motor

    def reset(self, position: float, velocity: float = 0.0) -> None:
        """A ball joint returns to the described pose; a fixed one stays."""
        if self.description.type == "ball":
            self._body.joints.reset_ball(self.name)

    def drive_velocity(self, velocity: float, effort: float) -> None:
        """No effect."""

    def drive_effort(self, effort: float) -> None:
        """No effect."""

    add_effort = drive_effort

    def change(self, lower: float, upper: float, damping: float) -> None:
        """No effect."""


class LoopBall(PassiveJoint):
    """A ball joint that closes a loop."""

    def __init__(self, description: JointDescription):
        super().__init__(description, None)

    def reset(self, position: float, velocity: float = 0.0) -> None:
        """No effect: determined by its links' poses, which the loop's other joints set."""

    def reaction(self) -> tuple[Vector3, Vector3]:
        """Zeros: the engine does not report the load of a loop's last joint."""
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)


class LoopJoint(LoopBall):
    """A joint that closes a loop: read from its links' poses, driven by forces on both."""

    def __init__(self, description: JointDescription, parent: Link | None, child: Link | None,
                 pose_world: Pose):
        """`parent` or `child` is None for the world; `pose_world` is the model's pose in it."""
        super().__init__(description)
        self._parent, self._child = parent, child
        self._pose_world = pose_world
        frame = _described(child) * description.pose  # of the joint, in the model
        self._in_parent = _described(parent).inverse() * frame

    def _ends(self) -> tuple[Pose, Pose]:
        """The joint's frame in the world, by the parent's pose and by the child's."""
        parent, child = (self._pose_world if link is None else link.pose
                         for link in (self._parent, self._child))
        return parent * self._in_parent, child * self.description.pose

    @property
    def position(self) -> float:
        """Angle within half a turn from the described pose, rad, or travel, m."""
        parent, child = self._ends()
        axis = self.description.axis
        apart = parent.inverse() * child
        if self.description.type == "prismatic":
            return dot(apart.position, axis)
        angle = 2.0 * math.atan2(dot(apart.orientation[:3], axis), apart.orientation[3])
        return math.remainder(angle, 2.0 * math.pi)

    @property
    def velocity(self) -> float:
        """Rate of `position`."""
        joint = self.description
        axis = rotate(self._ends()[0].orientation, joint.axis)
        part = "linear" if joint.type == "prismatic" else "angular"
        parent, child = (0.0 if link is None else dot(getattr(link.twist, part), axis)
                         for link in (self._parent, self._child))
        return child - parent

    def drive_effort(self, effort: float) -> None:
        """Effort (N m or N) during the next step."""
        axis = rotate(self._ends()[0].orientation, self.description.axis)
        for link, sign in ((self._child, effort), (self._parent, -effort)):
            if link is not None:
                push = tuple(sign * part for part in axis)
                if self.description.type == "prismatic":
                    link.apply_force(push)
                else:
                    link.apply_force((0.0, 0.0, 0.0), push)

    add_effort = drive_effort


class SingleJointGroup:
    """A joint that is not in the engine; replaces a JointGroup."""

    def __init__(self, joint: PassiveJoint):
        self.names = [joint.name]
        self._joint = joint

    def states(self) -> Sequence[tuple]:
        """A row: position, velocity, (not used), effort of the motor, which it does not have."""
        return [(self._joint.position, self._joint.velocity, None, 0.0)]

    def drive_efforts(self, efforts: Sequence[float]) -> None:
        """Effort (N m or N) during the next step."""
        if any(efforts):
            self._joint.drive_effort(efforts[0])


def _described(link: Link | None) -> Pose:
    return Pose() if link is None else link.description.pose


def joint_reaction(body: Body, link: PhysicsLink) -> tuple[Vector3, Vector3]:
    """The load of the joint that carries `link`: force (N) and torque (N m) about its anchor.

    As Gazebo's ODEJoint::GetForceTorque (physics/ode/ODEJoint.cc): of the joint's child on the
    joint, in the child link's frame, including the motor's effort; a weight hanging below is a
    downward force. The effort of a limit that is pressed against is missing along the
    axis. Zero until the step after the first call, unless the joint asked for feedback.
    """
    index = body.links.index[link.name]
    body.joints.enable_feedback(index)
    effort, row = body.joints.effort_and_load(index)
    # In the engine: of the parent on the child, about its centre of mass, in its principal axes.
    com = body.links.com_in_link(index)
    force = rotate(com.orientation, row[:3])
    torque = rotate(com.orientation, row[3:])
    joint = link.carrier
    moves = link.joint is not None
    if moves:
        along = tuple(effort * part for part in link.joint.axis)
        if link.joint.type == "prismatic":
            force = add(force, along)
        else:  # a ball joint's effort is 0
            torque = add(torque, along)
    anchor = (0.0, 0.0, 0.0) if moves or joint is None else joint.pose.position
    arm = tuple(c - a for c, a in zip(com.position, anchor, strict=True))
    torque = add(torque, cross(arm, force))
    if not link.turned:
        out = link.offset.orientation
        return negative(rotate(out, force)), negative(rotate(out, torque))
    # The engine's child is the described parent: the wrench on the described child is its negative.
    parent = next(other for other in body.tree.links if other.name == link.parent)
    here, there = (body.links.frame(each.name) for each in (link, parent))
    turn = multiply(conjugate(there.orientation), here.orientation)
    out = multiply(parent.offset.orientation, turn)
    return rotate(out, force), rotate(out, torque)

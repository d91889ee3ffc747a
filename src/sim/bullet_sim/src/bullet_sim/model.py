"""A model in the world: links and joints by name."""

import math
from collections.abc import Sequence
from dataclasses import replace

from bullet_sim.description import Inertial, JointDescription, ModelDescription
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.joint import Joint, LoopBall, LoopJoint, PassiveJoint, SingleJointGroup
from bullet_sim.link import Link, gravity_compensation
from bullet_sim.physics.assembly import WORLD, Tree, assemble, loop_joints
from bullet_sim.physics.axes import SECOND
from bullet_sim.physics.body import Body
from bullet_sim.physics.body_joints import JointGroup
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.collision_filters import CollisionFilters
from bullet_sim.physics.inertia import check_inertial
from bullet_sim.physics.levelling import levelled
from bullet_sim.physics.loop_constraints import LoopConstraints
from bullet_sim.physics.parameter_bounds import check_trees
from bullet_sim.physics.weld import Weld
from bullet_sim.pose import Pose, Vector3, rotate
from bullet_sim.twist import STILL, Twist, dot, shifted_twist, twist_difference


class Model:
    """A spawned description. Everything is in world coordinates unless a name says otherwise.

    SimulationError if the engine cannot hold it.
    """

    def __init__(self, name: str, description: ModelDescription, pose: Pose,
                 client: PhysicsClient):
        self.name = name
        self.description = description
        self.static = description.static
        self.initial_pose = pose
        self.bodies: list[Body] = []
        self._fixed_pose = pose  # of a model that is static or has no links
        self._link_states: dict[str, tuple[Pose, Twist]] | None = None
        self.has_recovered = False  # whether its pose or velocity was ever not finite
        self._auto_disable = client.auto_disable
        trees = [levelled(tree, client.surface_layer) for tree in assemble(description)]
        check_trees(name, trees)
        try:
            self._build(client, trees, pose)
        except Exception:
            self.remove()  # parts made before the failure
            raise

    def _build(self, client: PhysicsClient, trees: Sequence[Tree], pose: Pose) -> None:
        description = self.description
        for tree in trees:
            self.bodies.append(Body(client, tree, pose))
        loops = loop_joints(description, trees)
        LoopConstraints(client, description, self.bodies, loops)
        CollisionFilters(client, description, self.bodies)
        client.crowding.put(description, self.bodies)
        owner = {link.described: body for body in self.bodies for link in body.tree.links}
        self.links = {
            link.name: Link(self, link, owner[link.name]) for link in description.links
        }
        self._axes = {  # all that the engine can move, including second axes and travels of screws
            joint: Joint(body.joints.description(joint), body, self.forget)
            for body in self.bodies for joint in body.joints.index
        }
        self._find_joints(loops)
        self._steady = [body for body in self.bodies if body.acts_steadily]
        self.note_weightless()
        self._start_joints()

    def _start_joints(self) -> None:
        """Set joints to their positions in a saved world; the model frame stays."""
        pose = self.pose
        away = [joint for joint in self.description.joints if joint.start]
        for joint in away:
            self.joints[joint.name].reset(joint.start)
        if away:
            self.set_pose(pose)

    def _find_joints(self, loops: Sequence[JointDescription]) -> None:
        described = {joint.name: joint for joint in self.description.joints}
        self.joints: dict[str, Joint | PassiveJoint] = {
            name: joint for name, joint in self._axes.items() if name in described}
        for name, joint in self.joints.items():
            joint.second_axis = self._axes.get(name + SECOND)
        self.fixed_joints: dict[str, PassiveJoint] = {}
        for body in self.bodies:
            for link in body.tree.links:
                if link.carrier is not None and link.carrier.name not in self.joints:
                    held = PassiveJoint(described[link.carrier.name], body)
                    known = self.fixed_joints if held.description.type == "fixed" else self.joints
                    known[held.name] = held
        for joint in loops:
            ends = self.links.get(joint.parent), self.links.get(joint.child)
            if joint.type == "ball":
                self.joints[joint.name] = LoopBall(joint)
            elif joint.type not in ("fixed", "gearbox"):
                self.joints[joint.name] = LoopJoint(joint, *ends, self.initial_pose)

    # --- motion

    def forget(self) -> None:
        """Drop the cached link states."""
        self._link_states = None

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of each link, by name."""
        if self._link_states is None:
            self._link_states = {}
            for body in self.bodies:
                self._link_states.update(body.links.states())
            self._link_states.pop(WORLD, None)
        return self._link_states

    @property
    def pose(self) -> Pose:
        """Model frame, which keeps its pose relative to the first link."""
        if self.static or not self.description.links:
            return self._fixed_pose
        first = self.description.links[0]
        return self.link_states()[first.name][0] * first.pose.inverse()

    @property
    def twist(self) -> Twist:
        """Velocity of the model frame's origin, world axes."""
        if self.static or not self.description.links:
            return STILL
        pose, twist = self.link_states()[self.description.links[0].name]
        return shifted_twist(twist, pose.position, self.pose.position)

    def set_pose(self, pose: Pose) -> None:
        """Move the model as a whole; joints keep their positions."""
        self._displace(self.bodies, pose * self.pose.inverse())
        self._fixed_pose = pose

    def move_body(self, body: Body, change: Pose) -> None:
        """Move one of its bodies, or all of a static model's, by a displacement in the world."""
        self._displace(self.bodies if self.static else [body], change)
        self._fixed_pose = change * self._fixed_pose

    def _displace(self, bodies: list[Body], change: Pose) -> None:
        for body in bodies:
            body.links.set_base_frame(change * body.links.base_frame())
        self.forget()

    def set_velocity(self, twist: Twist) -> None:
        """Move as a whole with that twist of the model frame; joints keep turning."""
        for body in self.bodies:
            if not body.tree.fixed_base:
                body.links.set_twist(twist, self.pose.position)
        self.forget()

    def move_link(self, link: Link, pose: Pose, twist: Twist) -> None:
        """Set the pose of one of its links, with that velocity (world axes).

        Links connected by joints move with it; joints keep their positions and velocities. If it is
        fixed to the world, only the link's own joint moves, as far as it can.
        """
        body = link.body
        if body.tree.fixed_base and not self.static:
            state = _project_to_joint(link, pose, twist)
            if state is not None:
                name, position, rate = state
                self._axes[name].reset(position, rate)
            return
        self.move_body(body, pose * link.pose.inverse())
        if not body.tree.fixed_base:
            body.links.add_twist(twist_difference(twist, link.twist), pose.position)
            self.forget()

    def change_link(self, link: Link, inertial: Inertial, gravity: bool) -> None:
        """Change mass, centre of mass and inertia of a link, and whether gravity acts on it.

        SimulationError, without any change, if these are impossible.
        """
        check_inertial(inertial)
        if not self.static:
            link.body.change_inertial(link.name, inertial)
            self.forget()
        link.description = replace(link.description, inertial=inertial, gravity=gravity)
        self.note_weightless()

    def set_twist(self, twist: Twist) -> None:
        """Move as a rigid whole whose model frame has that twist; joints stop."""
        for joint in self._axes.values():
            joint.reset(joint.position)
        self.set_velocity(twist)

    def reset(self) -> None:
        """Reset to the pose it was spawned at, joints at zero, everything still.

        Welds stay, as Gazebo's joints between models do, and hold the links where they are then.
        """
        for joint in (*self._axes.values(), *self.joints.values()):
            joint.reset(0.0)
        for body in self.bodies:
            body.links.set_base_frame(self.initial_pose * body.base_pose_model)
        self._fixed_pose = self.initial_pose
        self.forget()
        self.set_twist(STILL)
        for weld in dict.fromkeys(each for body in self.bodies for each in body.attached
                                  if isinstance(each, Weld)):
            weld.renew()

    # --- for the world

    def note_weightless(self) -> None:
        """Note the links on which gravity does not act."""
        self._weightless = [] if self.static else [
            link for link in self.links.values() if not link.description.gravity]
        described = self.description
        for body in self.bodies:
            body.may_auto_disable = described.auto_disables and not (
                described.joints or self._weightless)

    def before_step(self, gravity: Vector3) -> None:
        """Apply the forces of every step; gravity in m/s^2."""
        if not (self._steady or self._weightless) or self._auto_disable.disabled:
            return  # at rest no step takes place, and the engine would add them up
        for body in self._steady:
            body.apply_steady()
        for link in self._weightless:
            link.apply_steady_force(gravity_compensation(link.description, gravity))

    def link(self, name: str) -> Link:
        """The link, or the one into which it was lumped over a fixed joint.

        UnknownName if there is none.
        """
        if name not in self.links:
            name = self._without_scope(name)
        name = self.description.lumped.get(name, (name, None))[0]
        if name not in self.links:
            raise UnknownName(f"link of model {self.name}", name, self.links)
        return self.links[name]

    def joint(self, name: str) -> Joint | PassiveJoint:
        """The joint of that name, also fixed ones, which are not in `joints`.

        UnknownName if there is none; SimulationError for one that cannot be read.
        """
        if name not in self.joints:
            name = self._without_scope(name)
        found = self.joints.get(name) or self.fixed_joints.get(name)
        if found is not None:
            return found
        held = [joint for joint in self.description.joints if joint.name == name]
        if held and self.static:
            raise SimulationError(f"joint {name!r} does not move, as model {self.name} is static; "
                                  "remove <static>")
        if held:
            raise SimulationError(f"joint {name!r} of model {self.name} is of type "
                                  f"{held[0].type}, which cannot be read or driven")
        raise UnknownName(f"joint of model {self.name}", name, self.joints)

    def _without_scope(self, name: str) -> str:
        """A part's name in the model; `MODEL::PART` is allowed, too (Gazebo's Model::GetJoint)."""
        return name.removeprefix(f"{self.name}::")

    def joint_groups(self, names: Sequence[str]) -> list[JointGroup]:
        """The joints of these names, to be read and driven together: one group per body.

        UnknownName and SimulationError as from `joint`.
        """
        for name in names:
            self.joint(name)
        groups = [body.joints.group(names) for body in self.bodies]
        groups += [SingleJointGroup(self.joint(name)) for name in names
                   if isinstance(self.joint(name), PassiveJoint)]
        return [group for group in groups if group.names]

    def remove(self) -> None:
        """Unload its bodies."""
        for body in self.bodies:
            body.remove()


def _project_to_joint(link: Link, pose: Pose, twist: Twist) -> tuple[str, float, float] | None:
    """Name, position and velocity (rad or m) of the joint that carries `link`, nearest to these.

    For a link held to the world by joints. `pose` and `twist` (of the link's origin) are in the
    world. None for a link that is fixed to the world or held by a ball joint.
    """
    body = link.body
    carrier = body.joints.moving_carrier(link.name)
    if carrier is None:
        return None
    joint, axis = carrier.joint, carrier.joint.axis
    frame = body.links.frame(carrier.name)
    wanted = pose * link.pose.inverse() * frame
    moved = frame.inverse() * wanted
    parent_pose, parent_twist = link.model.link_states().get(
        body.joints.described_parent(carrier), (Pose(), Twist()))
    own = twist_difference(
        twist, shifted_twist(parent_twist, parent_pose.position, pose.position))
    if joint.type == "prismatic":
        step, motion = dot(moved.position, axis), own.linear
    else:
        x, y, z, w = moved.orientation
        step = math.remainder(2.0 * math.atan2(dot((x, y, z), axis), w), 2.0 * math.pi)
        motion = own.angular
    position = body.joints.state(joint.name)[0] + step
    if joint.type != "continuous" and joint.lower <= joint.upper:
        position = max(joint.lower, min(joint.upper, position))
    return joint.name, position, dot(rotate(frame.orientation, axis), motion)

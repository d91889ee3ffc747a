"""One engine body: poses, velocities and motors of its links, by link name."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from bullet_sim.description import Inertial, LinkDescription
from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.inertia import sound_inertial
from bullet_sim.physics.joint_side import JointSide
from bullet_sim.physics.quiet import pybullet
from bullet_sim.physics.surfaces import contact_values
from bullet_sim.pose import IDENTITY, Pose, Vector3, normalised

FASTEST_JOINT = 1e3  # rad/s or m/s; the engine's own bound of 100 would hold a small wheel back
BASE = -1  # PyBullet's number of a body's base link


@dataclass(frozen=True)
class Twist:
    """Velocity of a frame's origin and its rate of turn, both in world axes."""

    linear: Vector3 = (0.0, 0.0, 0.0)  # m/s
    angular: Vector3 = (0.0, 0.0, 0.0)  # rad/s


STILL = Twist()


class Attachment(Protocol):
    """What hangs on the engine's body itself, and has to follow when it is made anew."""

    def attach(self) -> None:
        """The body is there."""
        ...

    def detach(self) -> None:
        """The body is about to go."""
        ...


class Body(JointSide):
    """A loaded tree. Link frames are those of the description, in the world."""

    def __init__(self, client: PhysicsClient, tree: Tree, pose_world_model: Pose):
        self.tree = tree
        self._client = client
        self.base_pose_model = tree.links[0].pose_parent
        self._index = {link.name: number - 1 for number, link in enumerate(tree.links)}
        self._physics_link = {link.name: link for link in tree.links}
        self._find_joints()
        self.attached: list[Attachment] = []
        self._link_indices = list(range(len(tree.links) - 1))
        self.put_in(pose_world_model * self.base_pose_model)
        self.on_unload: list[Callable[[], None]] = []  # to be called before the engine loses it
        client.rest.bodies.append(self)

    @property
    def client(self) -> PhysicsClient:
        """The engine that it is in."""
        return self._client

    # --- set-up

    def _load(self, frame: Pose) -> None:
        self.number = self._client.load(self.tree, frame)
        inertial = self.dynamics(BASE)
        self._pose_base_com = Pose(inertial[3], inertial[4])
        self._set_up_contacts()
        self._set_up_joints()
        for link in self.tree.links:
            if link.collisions and link.collisions[0].laser_retro:
                seen = self.number, self._index[link.name]
                self._client.retro[seen] = link.collisions[0].laser_retro

    def rebuild(self, links: dict[str, PhysicsLink]) -> None:
        """Give links of these names other masses, or joints other stops, in full motion.

        The engine can move no centre of mass and add no stop: it gets the body anew. Poses, rates
        and motors stay; whoever keeps the body's number has to ask for it again.
        """
        frame, base = self.base_frame(), self.tree.links[0].described
        at, twist = self.link_states()[base]
        joints = {name: self.joint_state(name) for name in self._joint_index}
        balls = {name: self._ball_state(name) for name in self._ball_index}
        motors = self._motors
        self.take_out()
        self.tree = replace(self.tree, links=[
            links.get(link.name, link) for link in self.tree.links])
        self._physics_link = {link.name: link for link in self.tree.links}
        self.put_in(frame, attach=False)
        for name, (position, rate) in joints.items():
            self.reset_joint(name, position, rate)
            if name in motors:
                self.drive_velocity(name, *motors[name])
        for name, (turn, rate) in balls.items():
            self.reset_ball(name, turn, rate)
        if not self.tree.held:
            self.set_twist(twist, at.position)
        for attachment in self.attached:
            attachment.attach()

    def take_out(self) -> None:
        """Out of the engine for a moment, with what hangs on it."""
        for attachment in self.attached:
            attachment.detach()
        self._unload()

    def put_in(self, frame: Pose, attach: bool = True) -> None:
        """Into the engine (again), still, the base's frame standing at `frame` in the world."""
        self._load(frame)
        self._client.planes.put(self.number, self.tree, frame)
        self._motors = {}
        for name in self._joint_index:
            self.release(name)
        for attachment in self.attached if attach else ():
            attachment.attach()

    def change_inertial(self, link: str, inertial: Inertial) -> None:
        """Other mass, centre of mass and inertia, in the described link's frame."""
        held = self._physics_link[link]
        sound = sound_inertial(inertial, held.collisions, f"link {link}")
        moved = replace(sound, pose=held.offset.inverse() * sound.pose)
        self.rebuild({link: replace(held, inertial=moved)})

    def change_joint(self, joint: str, **changes) -> None:
        """Other fields of its JointDescription: stops, damping, type."""
        held = self.tree.links[self._joint_index[joint] + 1]
        self.rebuild({held.name: replace(held, joint=replace(held.joint, **changes))})

    def dynamics(self, index: int) -> tuple:
        """PyBullet's row of a link: mass, friction, principal inertia, centre of mass ..."""
        return self._read(pybullet.getDynamicsInfo, index)

    def _set_up_contacts(self) -> None:
        # PyBullet damps by default; Gazebo does so only where a model asks for it.
        self._call(pybullet.changeDynamics, BASE, maxJointVelocity=FASTEST_JOINT)
        for link in self.tree.links:
            values = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}
            if link.joint is not None:
                values["jointDamping"] = link.joint.damping
            if link.collisions:
                com = self.com_in_link(self._index[link.name])
                values |= contact_values(link.collisions[0], self.tree.fixed, com)
            self._call(pybullet.changeDynamics, self._index[link.name], **values)

    # --- links

    def index(self, link: str) -> int:
        """The engine's number of a physics link; BASE for the first."""
        return self._index[link]

    def physics_link(self, name: str) -> PhysicsLink:
        """A link as the engine has it."""
        return self._physics_link[name]

    def com_in_link(self, index: int) -> Pose:
        """Centre of mass and principal axes in the engine's link frame."""
        row = self.dynamics(index)
        return Pose(row[3], row[4])

    def link_states(self) -> dict[str, tuple[Pose, Twist]]:
        """Pose and twist of every described link frame."""
        states = {}
        base = self.tree.links[0]
        linear, angular = self._read(pybullet.getBaseVelocity)
        states[base.described] = _described(
            base, self.base_frame(), self._com_position(BASE), linear, angular
        )
        rows = self._read(pybullet.getLinkStates, self._link_indices, computeLinkVelocity=1,
                          computeForwardKinematics=1) if self._link_indices else ()
        for link, row in zip(self.tree.links[1:], rows, strict=True):
            if link.name == link.described:
                states[link.name] = _described(link, Pose(row[4], row[5]), row[0], row[6], row[7])
        return states

    def base_frame(self) -> Pose:
        """The base link's frame in the world, as the engine has it."""
        pose_com = Pose(*self._read(pybullet.getBasePositionAndOrientation))
        return pose_com * self._pose_base_com.inverse()

    def engine_frame(self, index: int) -> Pose:
        """Frame of the engine's link of that number in the world."""
        if index == BASE:
            return self.base_frame()
        row = self._read(pybullet.getLinkState, index, computeForwardKinematics=1)
        return Pose(row[4], row[5])

    def centre(self, link: str) -> tuple[int, Pose]:
        """The engine's number of a link, and where its centre of mass is in the world."""
        index = self._index[link]
        inertial = self.dynamics(index)
        return index, self.engine_frame(index) * Pose(inertial[3], inertial[4])

    def set_base_frame(self, frame: Pose) -> None:
        """Put the base link's frame somewhere at once; joints keep their positions."""
        if not self._is_number("pose", *frame.position, *frame.orientation):
            return
        frame = Pose(frame.position, normalised(frame.orientation))
        com = frame * self._pose_base_com
        self._call(pybullet.resetBasePositionAndOrientation, com.position, com.orientation)
        self._client.planes.put(self.number, self.tree, frame)

    def set_twist(self, twist: Twist, origin: Vector3) -> None:
        """Move as a rigid whole whose point `origin` (world) has that twist."""
        if not self._is_number("velocity", *twist.linear, *twist.angular):
            return
        com = self._com_position(BASE)
        arm = [c - o for c, o in zip(com, origin, strict=True)]
        spin = cross(twist.angular, arm)
        linear = [v + s for v, s in zip(twist.linear, spin, strict=True)]
        self._call(pybullet.resetBaseVelocity, linear, twist.angular)

    def apply_steady_force(self, link: str, force: Vector3) -> None:
        """As `apply_force`, of what acts in every step: it does not end the world's rest."""
        index = self._index[link]
        self._read(pybullet.applyExternalForce, index, force, self._com_position(index),
                   pybullet.WORLD_FRAME)

    def apply_force(self, link: str, force: Vector3, torque: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Force (N) at the centre of mass and torque (N m), world axes, during the next step."""
        if not self._is_number("force", *force, *torque):
            return
        index = self._index[link]
        where = self._com_position(index)
        self._call(pybullet.applyExternalForce, index, force, where, pybullet.WORLD_FRAME)
        if any(torque):
            self._call(pybullet.applyExternalTorque, index, torque, pybullet.WORLD_FRAME)

    def add_twist(self, twist: Twist, origin: Vector3) -> None:
        """Change the base's motion by that of a rigid whole, `origin` (world) being its centre."""
        linear, angular = self._read(pybullet.getBaseVelocity)
        arm = [c - o for c, o in zip(self._com_position(BASE), origin, strict=True)]
        spin = cross(twist.angular, arm)
        self._call(pybullet.resetBaseVelocity,
                   [v + a + s for v, a, s in zip(linear, twist.linear, spin, strict=True)],
                   [w + a for w, a in zip(angular, twist.angular, strict=True)])

    def com_motion(self, index: int) -> tuple[Pose, Vector3, Vector3]:
        """Centre of mass and principal axes in the world, their velocity and rate of turn."""
        if index == BASE:
            pose = Pose(*self._read(pybullet.getBasePositionAndOrientation))
            return pose, *self._read(pybullet.getBaseVelocity)
        row = self._read(pybullet.getLinkState, index, computeLinkVelocity=1)
        return Pose(row[0], row[1]), row[6], row[7]

    def _com_position(self, index: int) -> Vector3:
        if index == BASE:
            return self._read(pybullet.getBasePositionAndOrientation)[0]
        return self._read(pybullet.getLinkState, index)[0]

    # --- leaving

    def remove(self) -> None:
        """Take the body out of the world."""
        self._client.rest.bodies.remove(self)
        for attachment in self.attached:
            attachment.detach()
        self.attached = []
        self._unload()

    def _unload(self) -> None:
        for action in list(self.on_unload):
            action()
        self._client.planes.remove(self.number)
        for seen in [seen for seen in self._client.retro if seen[0] == self.number]:
            del self._client.retro[seen]
        self._call(pybullet.removeBody)

    # --- rest

    def speeds(self) -> tuple[float, float]:
        """Greatest speed, m/s, and rate of turn, rad/s, of base and joints; NaN if any is."""
        linear, angular = self._read(pybullet.getBaseVelocity)
        speed, rate = max(map(abs, linear)), max(map(abs, angular))
        total = sum(linear) + sum(angular)
        for joint, index in self._joint_index.items():
            moved = abs(self._read(pybullet.getJointState, index)[1])
            total += moved
            if self.joint_description(joint).type == "prismatic":
                speed = max(speed, moved)
            else:
                rate = max(rate, moved)
        for joint in self._ball_index:
            rate = max(rate, *map(abs, self._ball_state(joint)[1]))
        return (speed, rate) if total == total else (math.nan, math.nan)


def cross(a, b) -> Vector3:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _described(link: PhysicsLink, physics_frame: Pose, com: Vector3, linear: Vector3,
               angular: Vector3) -> tuple[Pose, Twist]:
    """From the engine's frame and velocity of the centre of mass to those of the described link."""
    frame = physics_frame if link.offset is IDENTITY else physics_frame * link.offset.inverse()
    arm = [f - c for f, c in zip(frame.position, com, strict=True)]
    spin = cross(angular, arm)
    velocity = (linear[0] + spin[0], linear[1] + spin[1], linear[2] + spin[2])
    return frame, Twist(velocity, tuple(angular))


def gravity_compensation(link: LinkDescription, gravity: Vector3) -> Vector3:
    """Force that makes a link with `<gravity>` off weightless, N."""
    return tuple(-link.inertial.mass * g for g in gravity)

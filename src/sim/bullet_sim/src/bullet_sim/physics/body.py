"""One engine body: loaded from a tree, rebuilt for changes, unloaded."""

from __future__ import annotations

import contextlib
import math
from dataclasses import replace
from typing import Protocol

from bullet_sim.description import Inertial
from bullet_sim.physics import contact_parameters as contact
from bullet_sim.physics.assembly import PhysicsLink, Tree
from bullet_sim.physics.body_joints import BodyJoints
from bullet_sim.physics.body_links import BodyLinks
from bullet_sim.physics.client import BASE, NOWHERE, EngineBody, PhysicsClient
from bullet_sim.physics.engine import EngineError, pybullet
from bullet_sim.physics.held_wheels import HeldWheels
from bullet_sim.physics.inertia import sound_inertial
from bullet_sim.physics.steady_forces import Springs, VelocityDecay
from bullet_sim.pose import Pose

MANY_BODIES = 60  # from which on links without collisions are filtered out
FASTEST_JOINT = 1e3  # rad/s or m/s; the engine's own limit of 100 would slow a small wheel


class Attachment(Protocol):
    """A constraint or filter on the engine's body, made again whenever the body is.

    It is false if it has nothing to do.
    """

    bodies: list[Body]  # each once, and each has it in `attached`

    def attach(self) -> None:
        """Make it, after a body was loaded."""
        ...

    def detach(self) -> None:
        """Remove it, before a body is unloaded; a second call does nothing."""
        ...


def fasten(attachment: Attachment) -> None:
    """Attach it to its bodies, if it has any effect; after a failure, what it made is removed."""
    try:
        attachment.attach()
    except Exception:
        attachment.detach()
        raise
    if attachment:
        for body in attachment.bodies:
            body.attached.append(attachment)


class Body:
    """A loaded tree, with its `links` and `joints` by name."""

    def __init__(self, client: PhysicsClient, tree: Tree, pose_world_model: Pose):
        self.client = client
        self.engine = EngineBody(client, tree)
        self.links = BodyLinks(self.engine)
        self.joints = BodyJoints(self.engine, self.links)
        self.wheels = HeldWheels(self.engine, self.joints, self.links)
        self.joints.each_command = self.wheels.commanded
        self.base_pose_model = tree.links[0].pose_parent
        self._physics_link = {link.name: link for link in tree.links}
        self.attached: list[Attachment] = []
        self.may_auto_disable = True  # if its model allows it
        try:
            self.load(pose_world_model * self.base_pose_model)
        except Exception:
            self._destroy()  # half of it may be there
            raise
        client.auto_disable.bodies.append(self)

    @property
    def tree(self) -> Tree:
        """Its links and joints as they are in the engine."""
        return self.engine.tree

    @property
    def number(self) -> int:
        """The engine's number of it."""
        return self.engine.number

    @property
    def is_loaded(self) -> bool:
        """Whether it is in the engine."""
        return self.number != NOWHERE

    # --- set-up

    def _create(self, frame: Pose) -> None:
        self.engine.number = self.client.load(self.tree, frame)
        self.links.set_up()
        self._set_up_contacts()
        self.joints.set_up()
        self.wheels.set_up()
        steady = Springs(self.engine, self.joints), VelocityDecay(self.engine, self.links)
        self._steady = [each for each in steady if each]
        for link in self.tree.links:
            if link.collisions and link.collisions[0].laser_retro:
                seen = self.number, self.links.index[link.name]
                self.client.retro[seen] = link.collisions[0].laser_retro

    def rebuild(self, links: dict[str, PhysicsLink]) -> None:
        """Give links of these names other masses, or joints other limits, during motion.

        The engine cannot move a centre of mass or add a limit: the body is loaded again. Poses,
        velocities and motors stay; the body's number changes.
        """
        frame, base = self.links.base_frame(), self.tree.links[0].described
        at, twist = self.links.states()[base]
        joints = {name: self.joints.state(name) for name in self.joints.index}
        balls = {name: self.joints.ball_state(name) for name in self.joints.ball_index}
        motors = self.joints.motors
        self.unload()
        self.engine.tree = replace(self.tree, links=[
            links.get(link.name, link) for link in self.tree.links])
        self._physics_link = {link.name: link for link in self.tree.links}
        self.load(frame, attach=False)
        for name, (position, rate) in joints.items():
            self.joints.reset(name, position, rate)
            if name in motors:
                self.joints.drive_velocity(name, *motors[name])
        for name, (turn, rate) in balls.items():
            self.joints.reset_ball(name, turn, rate)
        if not self.tree.fixed_base:
            self.links.set_twist(twist, at.position)
        for attachment in self.attached:
            attachment.attach()

    def unload(self) -> None:
        """Unload it, with its attachments; `load` is the inverse."""
        self.joints.keep_loads()
        for attachment in self.attached:
            attachment.detach()
        self._destroy()

    def load(self, frame: Pose, attach: bool = True) -> None:
        """Load it into the engine, at rest, with the base's frame at `frame` in the world."""
        self._create(frame)
        self.client.planes.put(self.number, self.tree, frame)
        self.joints.release_all()
        for attachment in self.attached if attach else ():
            attachment.attach()

    def change_inertial(self, link: str, inertial: Inertial) -> None:
        """Change mass, centre of mass and inertia, in the described link's frame."""
        held = self._physics_link[link]
        sound = sound_inertial(inertial, held.collisions, f"link {link}")
        moved = replace(sound, pose=held.offset.inverse() * sound.pose)
        self.rebuild({link: replace(held, inertial=moved)})

    def change_joint(self, joint: str, **changes) -> None:
        """Change fields of its JointDescription: limits, damping, type."""
        held = self.tree.links[self.joints.index[joint] + 1]
        self.rebuild({held.name: replace(held, joint=replace(held.joint, **changes))})

    def _set_up_contacts(self) -> None:
        # PyBullet damps by default; SDF's <velocity_decay> is 0 by default.
        self.engine.change(pybullet.changeDynamics, BASE, maxJointVelocity=FASTEST_JOINT)
        mass = self._mass()
        many = len(self.client.auto_disable.bodies) >= MANY_BODIES
        for link in self.tree.links:
            if many and not link.collisions:
                # The engine pairs empty shapes in one place as well: a million of a thousand.
                self.engine.change(
                    pybullet.setCollisionFilterGroupMask, self.links.index[link.name], 0, 0)
            values = {"linearDamping": 0.0, "angularDamping": 0.0, "jointDamping": 0.0}
            if link.joint is not None:
                values["jointDamping"] = link.joint.damping
            if link.collisions:
                com = self.links.com_in_link(self.links.index[link.name])
                values |= contact.contact_values(link.collisions[0], self.tree.fixed, com, mass)
            self.engine.change(pybullet.changeDynamics, self.links.index[link.name], **values)

    def limit_correcting_velocity(self, part: float | None, timestep: float) -> None:
        """Let contacts correct at most this part of their depth per step (s); None: as usual."""
        mass = self._mass()
        for link in self.tree.links:
            if not link.collisions:
                continue
            values = contact.hardness(link.collisions[0].surface, self.tree.fixed, mass)
            if values and part is not None and part < contact.corrected_part(values, timestep):
                values = contact.correcting_velocity_values(part, timestep)
            if values:
                self.engine.change_without_waking(
                    pybullet.changeDynamics, self.links.index[link.name], **values)

    def _mass(self) -> float:
        return sum(link.inertial.mass for link in self.tree.links)

    # --- forces in every step

    def apply_steady(self) -> None:
        """Apply springs and velocity decay in the next step."""
        for each in self._steady:
            each.apply()

    @property
    def acts_steadily(self) -> bool:
        """Whether `apply_steady` has any effect."""
        return bool(self._steady)

    # --- removal

    def remove(self) -> None:
        """Remove the body from the world, even if the engine can no longer find it."""
        self.client.auto_disable.bodies.remove(self)
        for attachment in list(self.attached):
            with contextlib.suppress(EngineError):
                attachment.detach()
            for body in attachment.bodies:
                if attachment in body.attached:
                    body.attached.remove(attachment)
        self._destroy()

    def _destroy(self) -> None:
        if self.number == NOWHERE:
            return
        self.client.planes.remove(self.number)
        self.client.crowding.remove(self.number, len(self.tree.links))
        self.client.settling.pop(self.wheels, None)
        for seen in [seen for seen in self.client.retro if seen[0] == self.number]:
            del self.client.retro[seen]
        with contextlib.suppress(EngineError):
            self.engine.change(pybullet.removeBody)
        self.engine.number = NOWHERE

    # --- rest

    @property
    def auto_disables(self) -> bool:
        """Whether nothing but contacts and gravity acts on it."""
        return self.may_auto_disable and not (
            self.tree.fixed or self.joints.index or self.joints.ball_index or self.attached
            or self.acts_steadily)

    def speeds(self) -> tuple[float, float]:
        """Maximum speed, m/s, and angular velocity, rad/s, of base and joints; NaN if any is."""
        joints = self.joints.index
        if self.tree.fixed_base and not (joints or self.joints.ball_index):
            return 0.0, 0.0
        linear, angular = self.engine.read(pybullet.getBaseVelocity)
        speed, rate = max(map(abs, linear)), max(map(abs, angular))
        total = sum(linear) + sum(angular)
        rows = self.engine.read(pybullet.getJointStates, list(joints.values())) if joints else ()
        for joint, row in zip(joints, rows, strict=True):
            moved = abs(row[1])
            total += moved
            if self.joints.description(joint).type == "prismatic":
                speed = max(speed, moved)
            else:
                rate = max(rate, moved)
        for joint in self.joints.ball_index:
            rate = max(rate, *map(abs, self.joints.ball_state(joint)[1]))
        return (speed, rate) if total == total else (math.nan, math.nan)

"""The joints of an engine body, by name: read, reset, driven."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from statistics import fmean

from bullet_sim.description import JointDescription
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.body_links import BodyLinks
from bullet_sim.physics.client import EngineBody
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Quaternion, Vector3

JointWrench = tuple[float, Sequence[float]]  # effort of a motor; force and torque, (6,)
STRONGEST = 1e6  # N m or N; much more becomes NaN in the engine


class BodyJoints:
    """The joints of a Body; a joint's number in the engine is that of the link it carries."""

    def __init__(self, engine: EngineBody, links: BodyLinks):
        self._engine = engine
        self._links = links
        joints = [link for link in engine.tree.links if link.joint]
        self.index = {link.joint.name: links.index[link.name] for link in joints
                      if link.joint.type != "ball"}  # with one axis that can move
        self.ball_index = {link.joint.name: links.index[link.name] for link in joints
                           if link.joint.type == "ball"}  # which have no single angle
        self.motors: dict[str, tuple[float, float]] = {}  # joint: velocity and maximum effort
        self.each_command: Callable[[str], None] = lambda joint: None  # after one, with its joint
        self._feedback: dict[int, deque[JointWrench]] = {}  # of measured joints
        self._loads_before: dict[int, JointWrench] = {}  # of those, when the body was unloaded
        self._unloaded_at = 0  # in steps of the engine

    def set_up(self) -> None:
        """After the body was loaded: ball joints without a brake, and force sensors as before."""
        measured, self._feedback = list(self._feedback), {}
        for index in measured:  # also those measured after they were read
            self.enable_feedback(index)
        for index in self.ball_index.values():
            self._engine.change(  # the engine's default is a brake
                pybullet.setJointMotorControlMultiDof, index, pybullet.POSITION_CONTROL,
                targetPosition=(0.0, 0.0, 0.0, 1.0), positionGain=0.0, velocityGain=0.0,
                force=(0.0, 0.0, 0.0))
        for link in self._engine.tree.links:
            if link.carrier is not None and link.carrier.provide_feedback:
                self.enable_feedback(self._links.index[link.name])

    def carried_by(self, joint: str) -> PhysicsLink:
        """The described link that is carried by a joint of the description."""
        return next(link for link in self._engine.tree.links
                    if link.carrier is not None and link.carrier.name == joint)

    def moving_carrier(self, link: str) -> PhysicsLink | None:
        """The engine's link, this one or one that it is fixed to, moved by a joint with one axis.

        None if it is held by the world or a ball joint instead.
        """
        found = {each.name: each for each in self._engine.tree.links}
        each = found.get(link)
        while each is not None and (each.joint is None or (
                each.joint.type != "ball" and self.is_locked(each.joint.name))):
            each = found.get(each.parent)
        return None if each is None or each.joint.type == "ball" else each

    def described_parent(self, link: PhysicsLink) -> str:
        """The described link that is the parent of an engine's link."""
        return next(each.described for each in self._engine.tree.links if each.name == link.parent)

    def enable_feedback(self, index: int) -> None:
        """Enable the engine's force and torque sensor of the joint with that number."""
        if index not in self._feedback:
            self._feedback[index] = deque()
            self._engine.change(pybullet.enableJointForceTorqueSensor, index, 1)

    def effort_and_load(self, index: int) -> JointWrench:
        """A joint's motor effort in the last step, and its load as six numbers.

        In a world at rest they are means over the last steps: contacts vibrate, and the last step's
        value would be reported during the whole rest. Before the first step of a body that was
        unloaded and loaded again, the load is the one before.
        """
        rest = self._engine.client.auto_disable
        if self._unloaded_at == rest.steps and index in self._loads_before:
            return self._loads_before[index]
        rows = self._feedback.get(index)
        if not rows or not rest.disabled:
            return self._last_effort(index)
        efforts, loads = zip(*rows, strict=True)
        return fmean(efforts), tuple(map(fmean, zip(*loads, strict=True)))

    def keep_feedback(self) -> None:
        """Record the last step's loads; keeps as many steps as there are between two samples."""
        for index, rows in self._feedback.items():
            rows.append(self._last_effort(index))
            while len(rows) > self._engine.client.auto_disable.sample_steps:
                rows.popleft()

    def keep_loads(self) -> None:
        """Before the body is unloaded: store the loads to report until the next step."""
        loads = {index: self.effort_and_load(index) for index in self._feedback}
        self._loads_before = {index: load for index, load in loads.items()
                              if math.isfinite(load[0] + sum(load[1]))}
        self._unloaded_at = self._engine.client.auto_disable.steps

    def _last_effort(self, index: int) -> JointWrench:
        if index in self.ball_index.values():
            return 0.0, self._engine.read(pybullet.getJointStateMultiDof, index)[2]
        row = self._engine.read(pybullet.getJointState, index)
        return row[3], row[2]

    def ball_state(self, joint: str) -> tuple[Quaternion, Vector3]:
        """A ball joint's turn, and its rate in rad/s about the child's axes."""
        return self._engine.read(pybullet.getJointStateMultiDof, self.ball_index[joint])[:2]

    def reset_ball(self, joint: str, turn: Quaternion = (0.0, 0.0, 0.0, 1.0),
                   rate: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Turn a ball joint at once; `rate` in rad/s about the child's axes."""
        self._engine.change(pybullet.resetJointStateMultiDof, self.ball_index[joint], turn, rate)

    def state(self, joint: str) -> tuple[float, float]:
        """Position and velocity: rad and rad/s, or m and m/s."""
        row = self._engine.read(pybullet.getJointState, self.index[joint])
        return row[0], row[1]

    def reset(self, joint: str, position: float, velocity: float) -> None:
        """Set a joint's state at once."""
        if not self._engine.is_number("joint position", position, velocity):
            return
        self._engine.change(pybullet.resetJointState, self.index[joint], position, velocity)
        self.each_command(joint)

    def drive_velocity(self, joint: str, velocity: float, effort: float) -> None:
        """Motor that holds a velocity with at most `effort` (N m or N), until the next command.

        A negative effort counts as 0: no motor.
        """
        effort = min(max(effort, 0.0), STRONGEST)
        if self.motors.get(joint) == (velocity, effort):
            return
        if not self._engine.is_number("joint drive", velocity, effort):
            return
        self.motors[joint] = (velocity, effort)
        self._engine.change(pybullet.setJointMotorControl2, self.index[joint],
                            pybullet.VELOCITY_CONTROL, targetVelocity=velocity, force=effort)
        self.each_command(joint)

    def drive_effort(self, joint: str, effort: float) -> None:
        """Effort (N m or N) during the next step."""
        if self.motors.pop(joint, None):
            self.each_command(joint)
        self.add_effort(joint, effort)

    def add_effort(self, joint: str, effort: float) -> None:
        """Effort (N m or N) during the next step, added to motors and other efforts."""
        if self._engine.is_number("joint effort", effort):
            self._engine.change(pybullet.setJointMotorControl2, self.index[joint],
                                pybullet.TORQUE_CONTROL, force=effort)

    def motor(self, joint: str) -> tuple[float, float]:
        """The velocity that is held, and the maximum effort for it; zeros after a plain effort."""
        return self.motors.get(joint, (0.0, 0.0))

    def release_all(self) -> None:
        """No motors, after the body was loaded."""
        self.motors = {}
        for name in self.index:
            self.release(name)

    def release(self, joint: str) -> None:
        """No motor; the joint's own dry friction stays (PyBullet's default is a brake)."""
        friction = self.description(joint).friction
        self.drive_velocity(joint, 0.0, friction)

    def description(self, joint: str) -> JointDescription:
        """The joint as described."""
        return self._engine.tree.links[self.index[joint] + 1].joint

    def is_locked(self, joint: str) -> bool:
        """Whether the engine holds it, because both its limits are 0."""
        joint = self.description(joint)
        return joint.type != "continuous" and joint.lower == joint.upper == 0.0

    def group(self, joints: Iterable[str]) -> JointGroup:
        """A group of this body's joints among these."""
        indices = self.index
        return JointGroup(
            self._engine, {name: indices[name] for name in joints if name in indices})

    def wants_to_move(self) -> bool:
        """Whether a motor is to hold a velocity other than zero."""
        return any(velocity and effort for velocity, effort in self.motors.values())


class JointGroup:
    """Several joints of one body: one engine call takes a fifth of six. Positions in rad or m."""

    def __init__(self, engine: EngineBody, joints: dict[str, int]):
        self.names = list(joints)
        self._engine = engine
        self._indices = list(joints.values())

    def states(self) -> Sequence[tuple]:
        """A row for each joint: position, velocity, (not used), motor effort in the last step."""
        return self._engine.read(pybullet.getJointStates, self._indices)

    def drive_efforts(self, efforts: Sequence[float]) -> None:
        """Efforts (N m or N) during the next step, added to motors and friction."""
        if any(efforts):  # the engine drops them after each step: zeros need no call
            self._engine.change(pybullet.setJointMotorControlArray, self._indices,
                                pybullet.TORQUE_CONTROL, forces=efforts)

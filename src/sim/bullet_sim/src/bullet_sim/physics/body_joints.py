"""The joints of an engine body, by name: read, reset, driven."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Sequence
from statistics import fmean

from bullet_sim.description import JointDescription
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.engine import pybullet
from bullet_sim.physics.engine_handle import EngineHandle
from bullet_sim.pose import Quaternion, Vector3

JointWrench = tuple[float, Sequence[float]]  # effort of a motor; force and torque, (6,)
STRONGEST = 1e6  # N m or N; much more becomes NaN in the engine


class BodyJoints(EngineHandle):
    """The joints of a Body."""

    def _find_joints(self) -> None:
        joints = [link for link in self.tree.links if link.joint]
        self.joint_index = {link.joint.name: self.index[link.name] for link in joints
                             if link.joint.type != "ball"}
        self.ball_index = {link.joint.name: self.index[link.name] for link in joints
                            if link.joint.type == "ball"}
        self._motors: dict[str, tuple[float, float]] = {}  # joint: velocity and maximum effort
        self._feedback: dict[int, deque[JointWrench]] = {}  # of measured joints
        self._loads_before: dict[int, JointWrench] = {}  # of those, when the body was unloaded
        self._unloaded_at = 0  # in steps of the engine

    def _set_up_joints(self) -> None:
        measured, self._feedback = list(self._feedback), {}
        for index in measured:  # also those measured after they were read
            self.enable_feedback(index)
        for index in self.ball_index.values():
            self.change(pybullet.setJointMotorControlMultiDof, index, pybullet.POSITION_CONTROL,
                        targetPosition=(0.0, 0.0, 0.0, 1.0), positionGain=0.0, velocityGain=0.0,
                        force=(0.0, 0.0, 0.0))  # the engine's default is a brake
        for link in self.tree.links:
            if link.carrier is not None and link.carrier.provide_feedback:
                self.enable_feedback(self.index[link.name])

    def carried_by(self, joint: str) -> PhysicsLink:
        """The described link that is carried by a joint of the description."""
        return next(link for link in self.tree.links
                    if link.carrier is not None and link.carrier.name == joint)

    def moving_carrier(self, link: str) -> PhysicsLink | None:
        """The engine's link, this one or one that it is fixed to, moved by a joint with one axis.

        None if it is held by the world or a ball joint instead.
        """
        found = {each.name: each for each in self.tree.links}
        each = found.get(link)
        while each is not None and (each.joint is None or (
                each.joint.type != "ball" and self.is_locked(each.joint.name))):
            each = found.get(each.parent)
        return None if each is None or each.joint.type == "ball" else each

    def described_parent(self, link: PhysicsLink) -> str:
        """The described link that is the parent of an engine's link."""
        return next(each.described for each in self.tree.links if each.name == link.parent)

    def enable_feedback(self, index: int) -> None:
        """Enable the engine's force and torque sensor of the joint with that number."""
        if index not in self._feedback:
            self._feedback[index] = deque()
            self.change(pybullet.enableJointForceTorqueSensor, index, 1)

    def joint_effort(self, index: int) -> JointWrench:
        """A joint's motor effort in the last step, and its load as six numbers.

        In a world at rest they are means over the last steps: contacts vibrate, and the last step's
        value would be reported during the whole rest. Before the first step of a body that was
        unloaded and loaded again, the load is the one before.
        """
        if self._unloaded_at == self.client.auto_disable.steps and index in self._loads_before:
            return self._loads_before[index]
        rows = self._feedback.get(index)
        if not rows or not self.client.auto_disable.disabled:
            return self._last_effort(index)
        efforts, loads = zip(*rows, strict=True)
        return fmean(efforts), tuple(map(fmean, zip(*loads, strict=True)))

    def keep_feedback(self) -> None:
        """Record the last step's loads; keeps as many steps as there are between two samples."""
        for index, rows in self._feedback.items():
            rows.append(self._last_effort(index))
            while len(rows) > self.client.auto_disable.sample_steps:
                rows.popleft()

    def _keep_loads(self) -> None:
        """Before the body is unloaded: store the loads to report until the next step."""
        loads = {index: self.joint_effort(index) for index in self._feedback}
        self._loads_before = {index: load for index, load in loads.items()
                              if math.isfinite(load[0] + sum(load[1]))}
        self._unloaded_at = self.client.auto_disable.steps

    def _last_effort(self, index: int) -> JointWrench:
        if index in self.ball_index.values():
            return 0.0, self.read(pybullet.getJointStateMultiDof, index)[2]
        row = self.read(pybullet.getJointState, index)
        return row[3], row[2]

    def _ball_state(self, joint: str) -> tuple[Quaternion, Vector3]:
        return self.read(pybullet.getJointStateMultiDof, self.ball_index[joint])[:2]

    def reset_ball(self, joint: str, turn: Quaternion = (0.0, 0.0, 0.0, 1.0),
                   rate: Vector3 = (0.0, 0.0, 0.0)) -> None:
        """Turn a ball joint at once; `rate` in rad/s about the child's axes."""
        self.change(pybullet.resetJointStateMultiDof, self.ball_index[joint], turn, rate)

    def joint_state(self, joint: str) -> tuple[float, float]:
        """Position and velocity: rad and rad/s, or m and m/s."""
        row = self.read(pybullet.getJointState, self.joint_index[joint])
        return row[0], row[1]

    def reset_joint(self, joint: str, position: float, velocity: float) -> None:
        """Set a joint's state at once."""
        if not self._is_number("joint position", position, velocity):
            return
        self.change(pybullet.resetJointState, self.joint_index[joint], position, velocity)

    def drive_velocity(self, joint: str, velocity: float, effort: float) -> None:
        """Motor that holds a velocity with at most `effort` (N m or N), until the next command.

        A negative effort counts as 0: no motor.
        """
        effort = min(max(effort, 0.0), STRONGEST)
        if self._motors.get(joint) == (velocity, effort):
            return
        if not self._is_number("joint drive", velocity, effort):
            return
        self._motors[joint] = (velocity, effort)
        self.change(pybullet.setJointMotorControl2, self.joint_index[joint],
                    pybullet.VELOCITY_CONTROL, targetVelocity=velocity, force=effort)

    def drive_effort(self, joint: str, effort: float) -> None:
        """Effort (N m or N) during the next step."""
        self._motors.pop(joint, None)
        self.add_effort(joint, effort)

    def add_effort(self, joint: str, effort: float) -> None:
        """Effort (N m or N) during the next step, added to motors and other efforts."""
        if self._is_number("joint effort", effort):
            self.change(pybullet.setJointMotorControl2, self.joint_index[joint],
                        pybullet.TORQUE_CONTROL, force=effort)

    def motor(self, joint: str) -> tuple[float, float]:
        """The velocity that is held, and the maximum effort for it; zeros after a plain effort."""
        return self._motors.get(joint, (0.0, 0.0))

    def release(self, joint: str) -> None:
        """No motor; the joint's own dry friction stays (PyBullet's default is a brake)."""
        friction = self.joint_description(joint).friction
        self.drive_velocity(joint, 0.0, friction)

    def joint_description(self, joint: str) -> JointDescription:
        """The joint as described."""
        return self.tree.links[self.joint_index[joint] + 1].joint

    def is_locked(self, joint: str) -> bool:
        """Whether the engine holds it, because both its limits are 0."""
        joint = self.joint_description(joint)
        return joint.type != "continuous" and joint.lower == joint.upper == 0.0

    def joint_group(self, joints: Iterable[str]) -> JointGroup:
        """A group of this body's joints among these."""
        indices = self.joint_index
        return JointGroup(self, {name: indices[name] for name in joints if name in indices})

    def wants_to_move(self) -> bool:
        """Whether a motor is to hold a velocity other than zero."""
        return any(velocity and effort for velocity, effort in self._motors.values())


class JointGroup:
    """Several joints of one body: one engine call takes a fifth of six. Positions in rad or m."""

    def __init__(self, body: EngineHandle, joints: dict[str, int]):
        self.names = list(joints)
        self._body = body
        self._indices = list(joints.values())

    def states(self) -> Sequence[tuple]:
        """A row for each joint: position, velocity, (not used), motor effort in the last step."""
        return self._body.read(pybullet.getJointStates, self._indices)

    def drive_efforts(self, efforts: Sequence[float]) -> None:
        """Efforts (N m or N) during the next step, added to motors and friction."""
        if any(efforts):  # the engine drops them after each step: zeros need no call
            self._body.change(pybullet.setJointMotorControlArray, self._indices,
                              pybullet.TORQUE_CONTROL, forces=efforts)

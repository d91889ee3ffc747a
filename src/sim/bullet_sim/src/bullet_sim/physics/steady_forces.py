"""Forces of every step: springs and dampers in joints, and `<velocity_decay>` of links.

Springs and dampers are explicit in the engine: forces from the state before the step. If that would
oscillate instead of coming to rest (a wheel of 1e-5 kg m^2 with a damping of 0.7, as in many
robots), the coefficient is reduced so that the joint rests within a step or two, which looks the
same.

By `<velocity_decay>` a link loses a part of its velocity in every step (ODE manual, Damping). The
engine's own damping is the same for all links of a body and grows with the squared speed.
"""

import math

import numpy as np

from bullet_sim.physics.body_joints import BodyJoints
from bullet_sim.physics.body_links import BodyLinks
from bullet_sim.physics.client import EngineBody
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Vector3, conjugate, rotate

MOST_DAMPING = 0.5  # of inertia / step: half the velocity is lost in a step
MOST_STIFFNESS = 0.1  # of inertia / step^2: an oscillation takes at least 20 steps


class Springs:
    """Springs of one body; `apply` before each step. Reads inertias once, at current positions."""

    def __init__(self, engine: EngineBody, joints: BodyJoints):
        self._engine = engine
        described = [(index, joints.description(name)) for name, index in joints.index.items()]
        needed = [joint for _, joint in described if joint.damping or joint.spring_stiffness]
        inertia = _inertias(engine, joints) if needed else []
        self._springs: list[tuple[int, float, float]] = []  # joint, stiffness, rest position
        step = engine.client.timestep
        for (index, joint), held in zip(described, inertia, strict=False):
            if joint.damping > MOST_DAMPING * held / step:
                engine.change(pybullet.changeDynamics, index,
                              jointDamping=MOST_DAMPING * held / step)
            if joint.spring_stiffness:
                stiffness = min(joint.spring_stiffness, MOST_STIFFNESS * held / step ** 2)
                self._springs.append((index, stiffness, joint.spring_reference))

    def __bool__(self) -> bool:
        return bool(self._springs)

    def apply(self) -> None:
        """Apply the efforts of the next step; they do not end the world's rest."""
        indices = [index for index, _, _ in self._springs]
        states = self._engine.read(pybullet.getJointStates, indices)
        self._engine.change_without_waking(
            pybullet.setJointMotorControlArray, indices, pybullet.TORQUE_CONTROL,
            forces=[stiffness * (rest - state[0]) for (_, stiffness, rest), state
                    in zip(self._springs, states, strict=True)])


def _inertias(engine: EngineBody, joints: BodyJoints) -> list[float]:
    """The inertia that each joint moves if all others are free: kg m^2, or kg."""
    if joints.ball_index:  # the engine has no mass matrix for these: the child's own mass counts
        return [_own_inertia(engine, joints, name) for name in joints.index]
    positions = [joints.state(name)[0] for name in joints.index]
    moving = [index for index, name in enumerate(joints.index) if not joints.is_locked(name)]
    try:
        rows = engine.read(pybullet.calculateMassMatrix, [positions[index] for index in moving])
    except SystemError:  # PyBullet's error for no mass matrix, as for a door 1e9 m from its hinge
        return [_own_inertia(engine, joints, name) for name in joints.index]
    free = np.linalg.pinv(np.array(rows))[-len(moving):, -len(moving):] if moving else ()
    inertias = [math.inf] * len(joints.index)
    for place, index in enumerate(moving):
        inertias[index] = 1.0 / max(free[place][place], 1e-12)
    return inertias


def _own_inertia(engine: EngineBody, joints: BodyJoints, joint: str) -> float:
    mass, _, diagonal = engine.dynamics(joints.index[joint])[:3]
    return mass if joints.description(joint).type == "prismatic" else min(diagonal)


SLOWEST = 0.01  # m/s and rad/s below which nothing is lost: ODE's default thresholds


class VelocityDecay:
    """The velocity decay of one body; `apply` before each step."""

    def __init__(self, engine: EngineBody, links: BodyLinks):
        self._engine, self._motion = engine, links
        self._links = [
            (link.name, min(link.linear_damping, 1.0), min(link.angular_damping, 1.0))
            for link in engine.tree.links if link.linear_damping or link.angular_damping
            if not engine.tree.fixed or link.parent is not None]
        # The file's own: a held wheel's is another one (`held_wheels`).
        self._inertia = {name: engine.dynamics(links.index[name])[:3:2]
                         for name, *_ in self._links}

    def __bool__(self) -> bool:
        return bool(self._links)

    def apply(self) -> None:
        """Apply forces and torques that remove that part in the next step."""
        step = self._engine.client.timestep
        for name, linear, angular in self._links:
            index = self._motion.index[name]
            com, velocity, rate = self._motion.com_motion(index)
            mass, moments = self._inertia[name]
            if math.hypot(*velocity) > SLOWEST:
                self._push(pybullet.applyExternalForce, index,
                           [-linear * mass / step * v for v in velocity],
                           com.position)
            if math.hypot(*rate) > SLOWEST:
                own = rotate(conjugate(com.orientation), rate)
                torque = [-angular / step * i * w for i, w in zip(moments, own, strict=True)]
                self._push(pybullet.applyExternalTorque, index, rotate(com.orientation, torque))

    def _push(self, function, index: int, vector: Vector3, *where: Vector3) -> None:
        self._engine.change_without_waking(function, index, vector, *where, pybullet.WORLD_FRAME)

"""Springs and dampers in joints, as stiff as the engine's steps can solve.

Both are explicit in the engine: forces from the state before the step. If that would oscillate
instead of coming to rest (a wheel of 1e-5 kg m^2 with a damping of 0.7, as in many robots), the
coefficient is reduced so that the joint rests within a step or two, which looks the same.
"""

import math

import numpy as np

from bullet_sim.physics.body_joints import BodyJoints
from bullet_sim.physics.engine import pybullet

MOST_DAMPING = 0.5  # of inertia / step: half the velocity is lost in a step
MOST_STIFFNESS = 0.1  # of inertia / step^2: an oscillation takes at least 20 steps


class Springs:
    """Springs of one body; `apply` before each step. Reads inertias once, at current positions."""

    def __init__(self, body: BodyJoints):
        self._body = body
        described = [(body.joint_index[name], body.joint_description(name))
                     for name in body.joint_index]
        needed = [joint for _, joint in described if joint.damping or joint.spring_stiffness]
        inertia = _inertias(body, len(described)) if needed else []
        self._springs: list[tuple[int, float, float]] = []  # joint, stiffness, rest position
        step = body.client.timestep
        for (index, joint), held in zip(described, inertia, strict=False):
            if joint.damping > MOST_DAMPING * held / step:
                body.change(pybullet.changeDynamics, index,
                            jointDamping=MOST_DAMPING * held / step)
            if joint.spring_stiffness:
                stiffness = min(joint.spring_stiffness, MOST_STIFFNESS * held / step ** 2)
                self._springs.append((index, stiffness, joint.spring_reference))

    def __bool__(self) -> bool:
        return bool(self._springs)

    def apply(self) -> None:
        """Apply the efforts of the next step; they do not end the world's rest."""
        indices = [index for index, _, _ in self._springs]
        states = self._body.read(pybullet.getJointStates, indices)
        self._body.change_without_waking(
            pybullet.setJointMotorControlArray, indices, pybullet.TORQUE_CONTROL,
            forces=[stiffness * (rest - state[0]) for (_, stiffness, rest), state
                    in zip(self._springs, states, strict=True)])


def _inertias(body: BodyJoints, joints: int) -> list[float]:
    """The inertia that each joint moves if all others are free: kg m^2, or kg."""
    if body.ball_index:  # the engine has no mass matrix for these: the child's own mass counts
        return [_own_inertia(body, name) for name in body.joint_index]
    positions = [body.joint_state(name)[0] for name in body.joint_index]
    moving = [index for index, name in enumerate(body.joint_index) if not body.is_locked(name)]
    try:
        rows = body.read(pybullet.calculateMassMatrix, [positions[index] for index in moving])
    except SystemError:  # PyBullet's error for no mass matrix, as for a door 1e9 m from its hinge
        return [_own_inertia(body, name) for name in body.joint_index]
    free = np.linalg.pinv(np.array(rows))[-len(moving):, -len(moving):] if moving else ()
    inertias = [math.inf] * joints
    for place, index in enumerate(moving):
        inertias[index] = 1.0 / max(free[place][place], 1e-12)
    return inertias


def _own_inertia(body: BodyJoints, joint: str) -> float:
    mass, _, diagonal = body.dynamics(body.joint_index[joint])[:3]
    return mass if body.joint_description(joint).type == "prismatic" else min(diagonal)

"""Positions and velocities of named joints at one time."""

from collections.abc import Sequence
from dataclasses import dataclass

from bullet_sim.joint import Joint
from bullet_sim.world import World


@dataclass(frozen=True)
class JointReading:
    """Parallel lists, in the order of the request."""

    time: float  # s, simulated
    names: tuple[str, ...]
    positions: tuple[float, ...]  # rad or m
    velocities: tuple[float, ...]  # rad/s or m/s


def sample_joints(world: World, joints: Sequence[Joint]) -> JointReading:
    """Read the joints now."""
    return JointReading(
        world.time,
        tuple(joint.name for joint in joints),
        tuple(joint.position for joint in joints),
        tuple(joint.velocity for joint in joints),
    )

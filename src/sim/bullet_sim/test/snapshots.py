"""All models at one moment, as plain values that can be compared."""

from __future__ import annotations

from dataclasses import dataclass

from bullet_sim.pose import Pose
from bullet_sim.twist import Twist
from bullet_sim.world import World


@dataclass(frozen=True)
class ModelSnapshot:
    """One model at one moment, in the world frame."""

    pose: Pose
    twist: Twist
    links: dict[str, tuple[Pose, Twist]]
    joints: dict[str, tuple[float, float]]  # position (rad or m) and its rate


@dataclass(frozen=True)
class Snapshot:
    """The world at one moment."""

    time: float  # s, simulated
    models: dict[str, ModelSnapshot]


def take_snapshot(world: World) -> Snapshot:
    """Where the models are now."""
    return Snapshot(world.time, {
        name: ModelSnapshot(
            model.pose, model.twist, dict(model.link_states()),
            {joint.name: (joint.position, joint.velocity) for joint in model.joints.values()},
        )
        for name, model in world.models.items()
    })

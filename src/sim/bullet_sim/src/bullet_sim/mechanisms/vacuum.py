"""A suction cup: pulls near links to it, and carries them along."""

import math
from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.world import World


@dataclass(frozen=True)
class VacuumParameters:
    """Distances are between the origins of the links; defaults of gazebo_ros_vacuum_gripper."""

    max_force: float = 20.0  # N
    max_distance: float = 0.05  # m: farther links are not attracted
    min_distance: float = 0.01  # m: nearer links are moved to the cup's origin


class Vacuum:
    """Call `update` at every step while it is switched on."""

    def __init__(self, world: World, cup: Link, parameters: VacuumParameters):
        self._world, self._cup, self._parameters = world, cup, parameters

    def update(self) -> bool:
        """Pull at the links of other models; returns whether one is held."""
        held = False
        for model in self._world.models.values():
            if model is self._cup.model or model.static:
                continue
            for link in model.links.values():
                held = self._pull(model, link) or held
        return held

    def _pull(self, model: Model, link: Link) -> bool:
        limits, cup = self._parameters, self._cup.pose
        gap = [c - p for c, p in zip(cup.position, link.pose.position, strict=True)]
        distance = math.hypot(*gap)
        if distance > limits.max_distance:
            return False
        pose = link.pose
        if distance <= limits.min_distance:
            pose = Pose(cup.position, pose.orientation)
        model.move_link(link, pose, self._cup.twist)
        if distance > 0.0:
            # N, as in gazebo_ros_vacuum_gripper.cpp, UpdateChild
            force = min(1.0 / distance, limits.max_force)
            link.apply_force(tuple(force * g / distance for g in gap))
        return True

"""Ground truth: true pose and twist of a link, relative to another frame."""

from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.pose import Pose
from bullet_sim.twist import Twist, shifted_twist, twist_difference, twist_in
from bullet_sim.world import World


@dataclass(frozen=True)
class GroundTruthReading:
    """Pose and twist of a frame's origin, both in the axes of the reference frame."""

    time: float  # s, simulated
    pose: Pose
    twist: Twist


class GroundTruth:
    """A frame fixed to a link at `offset` (m, rad), relative to another link or to the world."""

    def __init__(self, world: World, link: Link, offset: Pose, reference: Link | None = None):
        self._world, self._link, self._offset, self._reference = world, link, offset, reference

    def sample(self) -> GroundTruthReading:
        """The current pose and twist."""
        pose = self._link.pose * self._offset
        twist = shifted_twist(self._link.twist, self._link.pose.position, pose.position)
        if self._reference is None:
            return GroundTruthReading(self._world.time, pose, twist)
        seen_from = self._reference.pose
        carried = shifted_twist(self._reference.twist, seen_from.position, pose.position)
        return GroundTruthReading(self._world.time, seen_from.inverse() * pose,
                                  twist_in(seen_from, twist_difference(twist, carried)))

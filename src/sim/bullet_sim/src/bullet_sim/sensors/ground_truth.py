"""Ground truth: pose and twist of a link as the world has them, seen from another frame."""

from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.pose import Pose, Vector3, conjugate, rotate
from bullet_sim.twist import Twist, cross
from bullet_sim.world import World


@dataclass(frozen=True)
class GroundTruthReading:
    """Pose and twist of a frame's origin, both in the axes of the frame it is seen from."""

    time: float  # s, simulated
    pose: Pose
    twist: Twist


class GroundTruth:
    """A frame fixed to a link at `offset` (m, rad), seen from another link or from the world."""

    def __init__(self, world: World, link: Link, offset: Pose, reference: Link | None = None):
        self._world, self._link, self._offset, self._reference = world, link, offset, reference

    def sample(self) -> GroundTruthReading:
        """Where it is now, and how it moves."""
        pose, twist = self._link.pose * self._offset, self._link.twist
        linear = _at(twist, self._link.pose.position, pose.position)
        if self._reference is None:
            return GroundTruthReading(self._world.time, pose, Twist(linear, twist.angular))
        seen_from, moving = self._reference.pose, self._reference.twist
        carried = _at(moving, seen_from.position, pose.position)
        back = conjugate(seen_from.orientation)
        seen = Twist(rotate(back, _difference(linear, carried)),
                     rotate(back, _difference(twist.angular, moving.angular)))
        return GroundTruthReading(self._world.time, seen_from.inverse() * pose, seen)


def _at(twist: Twist, origin: Vector3, point: Vector3) -> Vector3:
    """Velocity, m/s, of a point that a rigid body with this twist at `origin` carries."""
    spin = cross(twist.angular, _difference(point, origin))
    return tuple(v + s for v, s in zip(twist.linear, spin, strict=True))


def _difference(a: Vector3, b: Vector3) -> Vector3:
    return tuple(x - y for x, y in zip(a, b, strict=True))

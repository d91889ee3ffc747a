"""Infinite planes that coincide: only the first of them collides.

A course is a plane on the ground plane. With both, each wheel has two contacts at one point; the
solver splits the load between them, which doubles its work and halves its accuracy.
"""

from collections.abc import Callable

from bullet_sim.description import Collision, Plane, Surface
from bullet_sim.physics.assembly import Tree
from bullet_sim.pose import Pose, rotate

Place = tuple[float, ...]  # unit normal and distance from the origin (m), friction, restitution


class Planes:
    """Static bodies that are one plane; `switch(body, on)` sets whether one collides."""

    def __init__(self, switch: Callable[[int, bool], None]):
        self._switch = switch
        self._places: dict[int, Place] = {}
        self._idle: set[int] = set()

    def put(self, body: int, tree: Tree, frame: Pose) -> None:
        """A body was added or moved; `frame` is that of its base in the world."""
        collision = _only_plane(tree)
        if collision is not None:
            self._places[body] = _place(collision, frame)
            self._update()

    def remove(self, body: int) -> None:
        """A body was unloaded."""
        if self._places.pop(body, None) is not None:
            self._idle.discard(body)
            self._update()

    def _update(self) -> None:
        taken: set[Place] = set()
        for body, place in self._places.items():
            idle = place in taken
            taken.add(place)
            if idle != (body in self._idle):
                self._switch(body, not idle)
                self._idle ^= {body}


def _only_plane(tree: Tree) -> Collision | None:
    """The plane that is all there is, if it collides with everything."""
    if not tree.fixed or len(tree.links) != 1 or len(tree.links[0].collisions) != 1:
        return None
    collision = tree.links[0].collisions[0]
    meets_all = (collision.surface.collides
                 and collision.surface.collide_bitmask == Surface.collide_bitmask)
    return collision if isinstance(collision.geometry, Plane) and meets_all else None


def _place(collision: Collision, frame: Pose) -> Place:
    pose = frame * collision.pose
    normal = rotate(pose.orientation, collision.geometry.normal)
    distance = sum(n * p for n, p in zip(normal, pose.position, strict=True))
    surface = collision.surface
    # More than 1 counts as 1 on static bodies, see contact_parameters._friction.
    alike = (min(surface.mu, 1.0), surface.restitution, collision.laser_retro)
    return tuple(round(value, 6) for value in (*normal, distance, *alike))

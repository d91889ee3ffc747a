"""Refuses a model whose shapes lie in too many others.

The engine's time for a step grows by the square of the contacts when there are more than ever
before: 60 boxes in one place take 5 s, 120 of them a minute and a half.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence

from bullet_sim.description import ModelDescription, Plane
from bullet_sim.errors import SimulationError
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.engine import pybullet

USUAL = 10  # others in which a movable shape may lie: ground, building, neighbours
MOST_OVERLAPS = 2000  # of all movable shapes, beyond these: 50 boxes in one place
# The engine also pairs what cannot touch, static or empty shapes, in this part of the time.
APART = 5e-4
DEPTH = 0.1  # part of a shape's bounding box, on each side, in which others may lie

Shape = tuple[int, int]  # the engine's numbers of a body and of its link


class Crowded(SimulationError):
    """A model would lie in too many others."""


class Crowding:
    """Counts overlaps when models are added; `read` runs a pybullet function."""

    def __init__(self, read: Callable):
        self._read = read
        self._movable: dict[Shape, bool] = {}  # of shapes that can touch
        self._met: dict[Shape, set[Shape]] = defaultdict(set)  # shapes, by one they overlapped
        self._apart: dict[Shape, float] = {}  # the same of what cannot touch, by its time
        self._overlaps = 0.0  # of movable shapes, beyond the usual ones

    def put(self, model: ModelDescription, bodies: Iterable) -> None:
        """A model was added, as these bodies. Crowded if it lies in too many others."""
        touching_itself = model.self_collide or any(link.self_collide for link in model.links)
        own = {body.number for body in bodies}
        for body in bodies:
            for link in body.tree.links:
                shape = body.number, body.links.index[link.name]
                others = [other for other in self._overlapping(shape, link)
                          if touching_itself or other[0] not in own]
                self._count(shape, link, model.static, others)
                if self._overlaps > MOST_OVERLAPS:
                    raise Crowded(self._why(shape))

    def _overlapping(self, shape: Shape, link: PhysicsLink) -> list[Shape]:
        """What lies in it, without itself. A plane lies in nothing: it has no bounds."""
        if any(isinstance(collision.geometry, Plane) for collision in link.collisions):
            return []
        low, high = self._read(pybullet.getAABB, *shape)
        low, high = ([a + DEPTH * (b - a) for a, b in zip(*ends, strict=True)]
                     for ends in ((low, high), (high, low)))
        found = self._read(pybullet.getOverlappingObjects, low, high) or ()
        return [other for other in found if other != shape]

    def _count(self, shape: Shape, link: PhysicsLink, static: bool,
               others: Sequence[Shape]) -> None:
        if not (link.collisions and link.collisions[0].surface.collides):
            self._count_apart(shape, len(others))
            return
        self._movable[shape] = not static
        touched = [other for other in others if other in self._movable
                   and (self._movable[other] or not static)]
        self._count_apart(shape, len(others) - len(touched))
        for other in touched:
            self._pair(shape, other, set.add)

    def _pair(self, one: Shape, other: Shape, change: Callable[[set[Shape], Shape], None]) -> None:
        """Add each to what the other met, or take it from there."""
        for each, met in ((one, other), (other, one)):
            self._overlaps -= self._beyond(each)
            change(self._met[each], met)
            self._overlaps += self._beyond(each)

    def _beyond(self, shape: Shape) -> int:
        return max(len(self._met[shape]) - USUAL, 0) if self._movable[shape] else 0

    def _count_apart(self, shape: Shape, others: int) -> None:
        self._apart[shape] = APART * others
        self._overlaps += self._apart[shape]

    def _why(self, shape: Shape) -> str:
        low, high = self._read(pybullet.getAABB, *shape)
        at = " ".join(f"{(a + b) / 2 + 0.0:.3g}" for a, b in zip(low, high, strict=True))
        return (f"too many shapes lie in one another at {at}, so that a step would take minutes; "
                "give each a <pose> of its own")

    def remove(self, number: int, links: int) -> None:
        """A body of so many links was unloaded."""
        for index in range(-1, links - 1):
            shape = number, index
            for other in tuple(self._met[shape]):
                self._pair(shape, other, set.discard)
            del self._met[shape]
            self._movable.pop(shape, None)
            self._overlaps -= self._apart.pop(shape, 0.0)

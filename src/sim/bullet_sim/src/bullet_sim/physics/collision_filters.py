"""Which of a model's collisions can touch: bit masks, and rules for links of one model.

Links of one model only collide if both allow it by `<self_collide>`, and never if a joint
connects them (Gazebo's ODEPhysics::CollisionCallback). The engine's time for filters of pairs grows
by the square of their number: links that are many and never collide share a group instead.
"""

import itertools

from bullet_sim.description import ModelDescription
from bullet_sim.errors import SimulationError
from bullet_sim.physics.body import Body, fasten
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet

ALL_BITS = 0xFFFF  # SDF's default of collide_bitmask
SHIFT = 8  # of these bits in the engine's masks, past its own groups
MOST_PAIRS = 2000  # that are filtered one by one in a model: 0.1 s
RAYS = 1  # the engine's group of rays, and of movable bodies
# Body, engine's number of a link with collisions, described link.
FilteredLink = tuple[Body, int, str]


class CollisionFilters:
    """The filters of one model; made again whenever one of its bodies is."""

    def __init__(self, client: PhysicsClient, model: ModelDescription, bodies: list[Body]):
        self._client = client
        self.bodies = bodies
        self._static = model.static  # then none of its parts collide
        self._name = model.name
        self._pairs: list[tuple[int, int, int, int]] = []
        self._group = 0
        self._colliding = set() if model.static else {
            link.name for link in model.links if model.self_collide or link.self_collide}
        self._joined = {frozenset((joint.parent, joint.child)) for joint in model.joints
                        if joint.type != "gearbox"}
        fasten(self)

    def __bool__(self) -> bool:
        return bool(self._pairs or self._masked or self._group)

    def attach(self) -> None:
        """Set the engine's filters. SimulationError for too many that need one each."""
        parts = [(body, index, link.described) for body in self.bodies
                 for index, link in enumerate(body.tree.links, start=-1) if link.collisions]
        self._masked = False
        for body, index, _ in parts:
            self._mask(body, index)
        if self._static:
            return
        apart = (pair for pair in itertools.combinations(parts, 2) if self._needs_filter(*pair))
        few = list(itertools.islice(apart, MOST_PAIRS + 1))
        if len(few) > MOST_PAIRS:
            self._share_group(parts)
            return
        for one, other in few:
            pair = one[0].number, other[0].number, one[1], other[1]
            self._client.change(pybullet.setCollisionFilterPair, *pair, 0)
            self._pairs.append(pair)

    def _share_group(self, parts: list[FilteredLink]) -> None:
        if self._colliding or self._masked or not self._client.free_groups:
            raise SimulationError(
                f"model {self._name} has {len(parts)} links that collide with others but not with "
                "one another, which takes long; make them models of their own")
        self._group = self._client.free_groups.pop()
        for body, index, _ in parts:
            self._filter(body, index, self._group, ~self._group)

    def detach(self) -> None:
        """Remove them: the engine reuses numbers of bodies, and would filter the next ones."""
        for pair in self._pairs:
            self._client.change(pybullet.setCollisionFilterPair, *pair, 1)
        self._pairs = []
        if self._group:
            self._client.free_groups.append(self._group)
        self._group = 0

    def _mask(self, body: Body, index: int) -> None:
        surface = body.tree.links[index + 1].collisions[0].surface
        bits = surface.collide_bitmask & ALL_BITS if surface.collides else 0
        if bits == ALL_BITS:
            return
        self._masked = True
        group = bits << SHIFT
        others = group | RAYS if bits else 0
        self._filter(body, index, group, others)

    def _filter(self, body: Body, index: int, group: int, mask: int) -> None:
        self._client.change(pybullet.setCollisionFilterGroupMask, body.number, index, group, mask)

    def _needs_filter(self, one: FilteredLink, other: FilteredLink) -> bool:
        """Whether the engine would let them collide although they must not."""
        names = {one[2], other[2]}
        if one[0] is other[0] and not one[0].tree.self_collide:
            return False
        return len(names) == 1 or not names <= self._colliding or names in self._joined

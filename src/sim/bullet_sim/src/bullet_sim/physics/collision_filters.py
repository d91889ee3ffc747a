"""Which of a model's collisions can touch: bit masks, and rules for links of one model.

Links of one model only collide if both allow it by `<self_collide>`, and never if a joint
connects them (Gazebo's ODEPhysics::CollisionCallback).
"""

import itertools

from bullet_sim.description import ModelDescription
from bullet_sim.physics.body import Body, fasten
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet

ALL_BITS = 0xFFFF  # SDF's default of collide_bitmask
SHIFT = 8  # of these bits in the engine's masks, past its own groups
RAYS = 1  # the engine's group of rays, and of movable bodies
# Body, engine's number of a link with collisions, described link.
FilteredLink = tuple[Body, int, str]


class CollisionFilters:
    """The filters of one model; made again whenever one of its bodies is."""

    def __init__(self, client: PhysicsClient, model: ModelDescription, bodies: list[Body]):
        self._client = client
        self.bodies = bodies
        self._static = model.static  # then none of its parts collide
        self._pairs: list[tuple[int, int, int, int]] = []
        self._colliding = set() if model.static else {
            link.name for link in model.links if model.self_collide or link.self_collide}
        self._joined = {frozenset((joint.parent, joint.child)) for joint in model.joints
                        if joint.type != "gearbox"}
        fasten(self)

    def __bool__(self) -> bool:
        return bool(self._pairs or self._masked)

    def attach(self) -> None:
        """Set the engine's filters."""
        parts = [(body, index, link.described) for body in self.bodies
                 for index, link in enumerate(body.tree.links, start=-1) if link.collisions]
        self._masked = False
        for body, index, _ in parts:
            self._mask(body, index)
        for one, other in itertools.combinations(parts, 2) if not self._static else ():
            if self._needs_filter(one, other):
                pair = one[0].number, other[0].number, one[1], other[1]
                self._client.change(pybullet.setCollisionFilterPair, *pair, 0)
                self._pairs.append(pair)

    def detach(self) -> None:
        """Remove them: the engine reuses numbers of bodies, and would filter the next ones."""
        for pair in self._pairs:
            self._client.change(pybullet.setCollisionFilterPair, *pair, 1)
        self._pairs = []

    def _mask(self, body: Body, index: int) -> None:
        surface = body.tree.links[index + 1].collisions[0].surface
        bits = surface.collide_bitmask & ALL_BITS if surface.collides else 0
        if bits == ALL_BITS:
            return
        self._masked = True
        group = bits << SHIFT
        others = group | RAYS if bits else 0
        self._client.change(pybullet.setCollisionFilterGroupMask, body.number, index, group, others)

    def _needs_filter(self, one: FilteredLink, other: FilteredLink) -> bool:
        """Whether the engine would let them collide although they must not."""
        names = {one[2], other[2]}
        if one[0] is other[0] and not one[0].tree.self_collide:
            return False
        return len(names) == 1 or not names <= self._colliding or names in self._joined

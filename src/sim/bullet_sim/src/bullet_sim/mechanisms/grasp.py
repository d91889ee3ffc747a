"""Holds what fingers press from opposite sides, as friction in a simulation does not."""

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from bullet_sim.link import Link
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Vector3
from bullet_sim.world import World

LEAST_RATIO = 0.3  # of the smaller of two opposite forces to the larger


@dataclass(frozen=True)
class GraspParameters:
    """Defaults of GazeboGraspFix.cpp."""

    angle: float = math.radians(120)  # rad between two forces that count as opposite
    most_grips: int = 10  # the maximum of the count of updates with a grip
    enough_grips: int = 5  # with more than that, it is held
    release_tolerance: float = 0.005  # m that a finger may move from where it touched


@dataclass(frozen=True)
class _Touch:
    """Where a finger touched when the grip began."""

    finger: Link
    point: Vector3  # in the finger's frame, m
    distance: float  # m, from the origin of the held link


class Grasp:
    """One gripper; call `update` at its own rate. A held object is welded to the palm."""

    def __init__(self, world: World, palm: Link, fingers: Sequence[Link],
                 parameters: GraspParameters):
        self._world, self._palm, self._parameters = world, palm, parameters
        self._fingers = {finger.scoped_name: finger for finger in fingers}
        self._grips: dict[str, int] = {}
        self.held: Link | None = None

    def update(self) -> None:
        """Check the contacts of the last step."""
        if self.held is not None and self._world.models.get(self.held.model.name) \
                is not self.held.model:
            self.release()  # it was deleted
        gripped = {name: contacts for name, contacts in self._touching().items()
                   if self._gripped(contacts)}
        for name, contacts in gripped.items():
            self._count_up(name, contacts)
        for name in [name for name in self._grips if name not in gripped]:
            self._grips[name] = max(0, self._grips[name] - 1)
        if self.held is not None and self.held.scoped_name not in gripped:
            self._let_go_if_open()

    def release(self) -> None:
        """Release the object, and reset the counts."""
        if self.held is not None:
            self._weld.release()
        self.held = None
        self._grips.clear()

    def _touching(self) -> dict[str, dict[str, list[Contact]]]:
        """Contacts by the scoped name of the object's link, then of the finger's; object first."""
        found: dict[str, dict[str, list[Contact]]] = defaultdict(lambda: defaultdict(list))
        for contact in self._world.contacts():
            first, second = contact.links
            if second in self._fingers and self._may_be_held(first):
                found[first][second].append(contact)
            elif first in self._fingers and self._may_be_held(second):
                found[second][first].append(contact.reversed())
        return found

    def _may_be_held(self, name: str) -> bool:
        model = self._world.link(name).model
        return model is not self._palm.model and not model.static

    def _gripped(self, contacts: dict[str, list[Contact]]) -> bool:
        """Whether two fingers push against each other."""
        forces = [_mean([contact.force for contact in some]) for some in contacts.values()]
        return any(_opposite(a, b, self._parameters.angle)
                   for number, a in enumerate(forces) for b in forces[:number])

    def _count_up(self, name: str, contacts: dict[str, list[Contact]]) -> None:
        p = self._parameters
        self._grips[name] = min(self._grips.get(name, 0) + 1, p.most_grips)
        if self.held is not None or self._grips[name] <= p.enough_grips:
            return
        self.held = self._world.link(name)
        self._weld = self.held.attach(self._palm)
        middle = self.held.pose.position
        self._touches = []
        for finger, some in contacts.items():
            point = _mean([contact.position for contact in some])
            link = self._fingers[finger]
            self._touches.append(_Touch(link, link.pose.inverse().transform(point),
                                        math.dist(point, middle)))

    def _let_go_if_open(self) -> None:
        """Release if fingers have moved away: they may lose contact in motion without that."""
        grips = self._grips.get(self.held.scoped_name, 0)
        if grips <= self._parameters.enough_grips and self._moved_off():
            self.release()

    def _moved_off(self) -> bool:
        middle = self.held.pose.position
        return any(abs(math.dist(touch.finger.pose.transform(touch.point), middle)
                       - touch.distance) > self._parameters.release_tolerance
                   for touch in self._touches)


def _mean(vectors: Sequence[Vector3]) -> Vector3:
    return tuple(sum(parts) / len(vectors) for parts in zip(*vectors, strict=True))


def _opposite(a: Vector3, b: Vector3, least_angle: float) -> bool:
    lengths = sorted((math.hypot(*a), math.hypot(*b)))
    if lengths[0] == 0.0 or lengths[0] < LEAST_RATIO * lengths[1]:
        return False
    cosine = sum(x * y for x, y in zip(a, b, strict=True)) / (lengths[0] * lengths[1])
    return math.acos(max(-1.0, min(1.0, cosine))) >= least_angle

"""Contact sensor: the collisions that touch a link's, pair by pair."""

import logging
from dataclasses import dataclass, field

import numpy as np

from bullet_sim.description import SensorDescription
from bullet_sim.link import Link
from bullet_sim.physics.contacts import Contact
from bullet_sim.pose import Vector3, rotation_matrix, symmetric_matrix
from bullet_sim.twist import cross, shifted_twist
from bullet_sim.world import World

log = logging.getLogger(__name__)

ALL = ("", "__default__")  # of a sensor that names no collision


@dataclass
class TouchingPair:
    """Two collisions that touch; parallel lists, world axes, one entry per point."""

    own: str  # model::link::collision
    other: str
    positions: list[Vector3] = field(default_factory=list)  # m
    normals: list[Vector3] = field(default_factory=list)  # unit, into the own one
    depths: list[float] = field(default_factory=list)  # m
    forces: list[Vector3] = field(default_factory=list)  # N, on the own one
    torques: list[Vector3] = field(default_factory=list)  # N m, about its link's centre of mass


class ContactSensor:
    """`<contact><collision>` names the collisions; a sensor without any covers all of its link.

    If several are named, they may be of other links: `model::link::collision` is any.
    """

    def __init__(self, world: World, link: Link, description: SensorDescription):
        self._world, self._link = world, link
        element = description.element
        written = [] if element is None else [
            (child.text or "").strip() for child in element.findall("contact/collision")]
        known = {shape.name: f"{link.scoped_name}::{shape.name}"
                 for shape in link.description.collisions}
        wanted = [name for name in written if name not in ALL]
        for name in wanted:
            if name not in known and "::" not in name:
                log.error("sensor %s of %s feels nothing at collision %r, which is not there; "
                          "there are: %s", description.name, link.scoped_name, name,
                          ", ".join(known) or "none")
        self._own = {known.get(name, name) for name in wanted} if wanted else set(known.values())

    def sample(self) -> list[TouchingPair]:
        """The pairs that touched in the last step."""
        pairs: dict[tuple[str, str], TouchingPair] = {}
        for contact in self._world.contacts():
            if contact.collision1 in self._own:
                self._note(pairs, contact)
            elif contact.collision2 in self._own:
                self._note(pairs, contact.reversed())
        return list(pairs.values())

    def _note(self, pairs: dict[tuple[str, str], TouchingPair], contact: Contact) -> None:
        names = contact.collision1, contact.collision2
        pair = pairs.setdefault(names, TouchingPair(*names))
        link = self._world.link(contact.links[0])
        centre = (link.pose * link.description.inertial.pose).position
        arm = tuple(p - c for p, c in zip(contact.position, centre, strict=True))
        pair.positions.append(contact.position)
        pair.normals.append(contact.normal)
        pair.depths.append(contact.depth)
        pair.forces.append(contact.force)
        pair.torques.append(cross(arm, contact.force))


class NetForce:
    """World axes, torque about the centre of mass; means since the last sample."""

    def __init__(self, world: World, link: Link):
        self._world, self._link = world, link
        self.restart()

    def restart(self) -> None:
        """Forget the last momentum."""
        self._last: tuple[float, np.ndarray] | None = None

    def sample(self) -> np.ndarray:
        """(6,) force in N and torque in N m; zeros at first."""
        now, momentum = self._world.time, self._momentum()
        rate = np.zeros(6)
        if self._last is not None and now > self._last[0]:
            rate = (momentum - self._last[1]) / (now - self._last[0])
        self._last = (now, momentum)
        return rate

    def _momentum(self) -> np.ndarray:
        """(6,) linear, kg m/s, and angular about the centre of mass, kg m^2/s."""
        inertial, frame = self._link.description.inertial, self._link.pose
        centre = frame * inertial.pose
        twist = shifted_twist(self._link.twist, frame.position, centre.position)
        turn = rotation_matrix(centre.orientation)
        tensor = turn @ symmetric_matrix(inertial.inertia) @ turn.T
        return np.concatenate([inertial.mass * np.array(twist.linear),
                               tensor @ np.array(twist.angular)])

"""The engine's contacts, with the names of the description's collisions.

Conventions are those of ODE's dContactGeom: the normal points into body 1, the force is the one on
body 1. Nothing is read unless asked for, so that it costs nothing otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from bullet_sim.description import Box, Collision, Cylinder, Geometry, Mesh, Plane, Sphere
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.physics.body import Body
from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet
from bullet_sim.pose import Pose, Vector3, conjugate, rotate


@dataclass(frozen=True)
class Contact:
    """A point at which two collisions touch, after the last step; world axes."""

    collision1: str  # model::link::collision
    collision2: str
    position: Vector3  # m, on the surface of body 2
    normal: Vector3  # unit, from body 2 into body 1
    depth: float  # m, penetration; 0 or more
    force: Vector3  # N, of this point on body 1, including friction

    @property
    def links(self) -> tuple[str, str]:
        """Scoped names of the links that touch."""
        return self.collision1.rpartition("::")[0], self.collision2.rpartition("::")[0]

    def reversed(self) -> Contact:
        """The same contact from the other body's view."""
        normal, force = (tuple(-part for part in v) for v in (self.normal, self.force))
        return Contact(self.collision2, self.collision1, self.position, normal, self.depth, force)


class Touched:
    """Finds the collision to which a point of an engine's link belongs."""

    def __init__(self, bodies: Iterable[tuple[str, Body]]):
        self._bodies = {body.number: (model, body) for model, body in bodies}
        self._frames: dict[tuple[int, int], Pose] = {}  # engine links in the world

    def name(self, number: int, index: int, point: Vector3) -> str:
        """Scoped name of the collision at a point in the world."""
        model, body = self._bodies[number]
        link = body.tree.links[index + 1]
        if len(link.collisions) > 1:
            key = number, index
            if key not in self._frames:
                self._frames[key] = body.links.engine_frame(index).inverse()
            point = (self._frames[key] * Pose(point)).position
        return f"{model}::{link.described}::{nearest_collision(link.collisions, point).name}"


def read_contacts(client: PhysicsClient, bodies: Iterable[tuple[str, Body]]) -> list[Contact]:
    """All contacts of the last step; `bodies` are model names and their bodies."""
    touched = Touched(bodies)
    contacts = []
    for row in client.read(pybullet.getContactPoints):
        _, body1, body2, link1, link2, on1, on2, normal, distance, push = row[:10]
        if distance > 0.0 and push == 0.0:
            continue  # near, but not touching: the engine predicts contacts
        rub1, along1, rub2, along2 = row[10:14]
        force = tuple(
            push * n + rub1 * a + rub2 * b for n, a, b in zip(normal, along1, along2, strict=True))
        contacts.append(Contact(
            touched.name(body1, link1, on1), touched.name(body2, link2, on2),
            tuple(on2), tuple(normal), max(-distance, 0.0), force))
    return contacts


def nearest_collision(collisions: list[Collision], point: Vector3) -> Collision:
    """The collision whose surface is nearest to a point; both in one frame."""
    if len(collisions) == 1:
        return collisions[0]
    return min(collisions, key=lambda collision: _gap(collision, point))


def _gap(collision: Collision, point: Vector3) -> float:
    arm = tuple(p - c for p, c in zip(point, collision.pose.position, strict=True))
    local = rotate(conjugate(collision.pose.orientation), arm)
    return abs(signed_distance(collision.geometry, local))


def signed_distance(geometry: Geometry, point: Vector3) -> float:
    """Distance from a shape's surface, m, negative inside; a mesh counts as its bounding box.

    FormatError for a mesh that cannot be read.
    """
    x, y, z = point
    match geometry:
        case Sphere(radius):
            return math.hypot(x, y, z) - radius
        case Cylinder(radius, length):
            return _outside((math.hypot(x, y) - radius, abs(z) - length / 2))
        case Box(size):
            return _outside([abs(p) - s / 2 for p, s in zip(point, size, strict=True)])
        case Plane(normal, _):
            return sum(n * p for n, p in zip(normal, point, strict=True)) / math.hypot(*normal)
        case Mesh():
            vertices, _ = collision_mesh(geometry)
            low, high = vertices.min(axis=0), vertices.max(axis=0)
            return _outside([max(a - p, p - b) for p, a, b in zip(point, low, high, strict=True)])
    return math.hypot(x, y, z)


def _outside(gaps) -> float:
    """Distance from where all gaps are negative; inside, minus that to the nearest side."""
    return math.hypot(*(max(gap, 0.0) for gap in gaps)) + min(max(gaps), 0.0)

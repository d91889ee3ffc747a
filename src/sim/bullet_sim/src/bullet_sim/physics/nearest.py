"""The distance of a point to a shape: identifies which of a link's collisions touched."""

from __future__ import annotations

import math

from bullet_sim.description import Box, Collision, Cylinder, Geometry, Mesh, Plane, Sphere
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.pose import Vector3, conjugate, rotate


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
    """From a shape's surface, m, negative inside; a mesh counts as the box around it."""
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
    """Distance from where all gaps are zero or less; inside, minus the way to the nearest side."""
    return math.hypot(*(max(gap, 0.0) for gap in gaps)) + min(max(gaps), 0.0)

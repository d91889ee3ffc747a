"""Wheels as the engine gets them: crowned, so that they stand and turn on their middle.

The engine finds one point of a cylinder on a plane, on one of its edges, and keeps those that it
found before: robots turned on the outer edges of their wheels, 10 % too slowly where these are as
wide as an eighth of the track, and points behind an axle set wheels without motors rolling.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from bullet_sim.description import Collision, Cylinder
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.pose import rotate

ROLLING = ("revolute", "continuous")
# Twice the margin that the engine rounds edges with: the tread has one lowest point, and what is
# found in the next step takes its place. At 3 mm free wheels of 3 cm began to roll again.
TREAD = 0.002  # m, its width
CROWN = 1e-4  # m, by which the shoulders' radius is less; the tread sinks in by about half
THINNEST = 0.005  # m, radius
ALONG = 0.999  # cosine: the cylinder lies along the joint's axis
CENTRED = 1e-3  # m, that its middle may be off that axis


def engine_shapes(link: PhysicsLink) -> Iterable[Collision]:
    """The link's collisions; wheels come as a narrow tread and the shoulders beside it."""
    for collision in link.collisions:
        if not _is_wheel(link, collision):
            yield collision
            continue
        radius, width = collision.geometry.radius, collision.geometry.length
        yield replace(collision, geometry=Cylinder(radius, TREAD))
        yield replace(collision, geometry=Cylinder(radius - CROWN, width))


def rolls(link: PhysicsLink, collision: Collision) -> bool:
    """Whether the link turns about an axis through the middle of the collision."""
    if link.joint is None or link.joint.type not in ROLLING:
        return False
    axis, centre = link.joint.axis, collision.pose.position
    along = sum(a * b for a, b in zip(centre, axis, strict=True)) / math.hypot(*axis)
    return math.hypot(*centre) ** 2 - along ** 2 < CENTRED ** 2


def _is_wheel(link: PhysicsLink, collision: Collision) -> bool:
    """Whether it is a cylinder that turns about its own axis."""
    shape = collision.geometry
    if not isinstance(shape, Cylinder) or not rolls(link, collision):
        return False
    if shape.radius < THINNEST or shape.length <= TREAD:
        return False
    axis = link.joint.axis
    own = rotate(collision.pose.orientation, (0.0, 0.0, 1.0))
    return abs(sum(a * b for a, b in zip(own, axis, strict=True))) > ALONG * math.hypot(*axis)

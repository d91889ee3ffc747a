"""Wheel shapes for the engine: crowned, so that their contact is in the middle.

The engine finds one point of a cylinder on a plane, on one of its edges, and keeps earlier ones:
robots turned on the outer edges of their wheels, 10 % too slowly if these are as wide as an eighth
of the track, and points behind an axle made wheels without motors roll.
So it did with meshes: one that is approximately round rolls as its circumscribed circle.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from bullet_sim.description import Box, Collision, Cylinder, Mesh, Sphere
from bullet_sim.errors import FormatError
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.pose import Pose, Quaternion, Vector3, rotate, rotation_matrix

ROLLING = ("revolute", "continuous")
# Twice the margin by which the engine rounds edges: the tread has one lowest point, and the one
# found in the next step replaces it. At 3 mm free wheels of 3 cm began to roll again.
TREAD = 0.002  # m, its width
# Part of half the diagonal of a link's box within which the engine sees contacts (Bullet:
# gContactBreakingThreshold): shoulders that are nearer to flat ground than this carry nothing, and
# cost the solver three rows each. They reach it when the wheel tilts.
SEEN = 0.02
CROWNED = 1.1  # times that the shoulders' radius is less; the tread sinks in by less than the rest
# Width and crown over radius: wider tyres may keep a robot upright with their shoulders,
# and a box larger than the wheel's has something else in it. There the radius is hardly less:
WIDE, MOST_CROWN = 1.0, 0.04
LEAST_CROWN = 1e-4  # m; the tread sinks in by about half
THINNEST = 0.005  # m, radius
ALONG = 0.999  # cosine: the cylinder is along the joint's axis
CENTRED = 1e-3  # m, maximum distance of its centre from that axis
ROUND = 0.95  # a mesh's minimum radius relative to its maximum; ten corners are about round
RIM = 0.99  # part of the maximum radius: the tread is in the middle of the points beyond it
DIRECTIONS = 100  # in which a mesh's radius is measured


@dataclass(frozen=True)
class Tyre:
    """The rolling shape of a collision."""

    radius: float  # m
    width: float  # m
    middle: Pose  # of the tread, in the link's frame; its z is the axis


def engine_shapes(link: PhysicsLink) -> Iterable[Collision]:
    """The link's collisions; wheels become a narrow tread and the shoulders next to it."""
    for collision in link.collisions:
        tyre = find_tyre(link, collision)
        if tyre is None or tyre.radius < THINNEST or tyre.width <= TREAD:
            yield collision
            continue
        yield replace(collision, geometry=Cylinder(tyre.radius, TREAD), pose=tyre.middle)
        yield resized(collision, crown(link, tyre), tyre.radius, tyre.middle.position)


def crown(link: PhysicsLink, tyre: Tyre) -> float:
    """By how much the radius of a tyre's shoulders is less than that of its tread, m."""
    unseen = CROWNED * SEEN * _half_diagonal(link)
    if tyre.width > WIDE * tyre.radius or unseen > MOST_CROWN * tyre.radius:
        return LEAST_CROWN
    return unseen


def _half_diagonal(link: PhysicsLink) -> float:
    """Half the diagonal of the box around a link's collisions, along its axes, m."""
    corners = np.concatenate([_corners(collision) for collision in link.collisions])
    return 0.5 * float(np.linalg.norm(np.ptp(corners, axis=0)))


def _corners(collision: Collision) -> np.ndarray:
    """Points (n, 3) in the link's frame, whose box along its axes holds the shape, m."""
    turn = rotation_matrix(collision.pose.orientation)
    match collision.geometry:
        case Sphere(radius):
            return np.array((-radius, radius))[:, None] + collision.pose.position
        case Cylinder(radius, length):
            half = np.array((radius, radius, length / 2))
        case Box(size):
            half = np.array(size) / 2
        case Mesh():
            try:
                return collision_mesh(collision.geometry)[0] @ turn.T + collision.pose.position
            except FormatError:  # reported where the shape is made
                return np.zeros((0, 3))
        case _:
            return np.zeros((0, 3))
    reach = np.abs(turn) @ half
    return np.stack((-reach, reach)) + collision.pose.position


def resized(collision: Collision, less: float, radius: float, centre: Vector3) -> Collision:
    """A shape that rolls about `centre`, its radius reduced (m); a mesh is scaled as a whole."""
    shape = collision.geometry
    if not isinstance(shape, Mesh):
        return replace(collision, geometry=replace(shape, radius=shape.radius - less))
    part = 1.0 - less / radius
    place = tuple(c + part * (p - c)
                  for p, c in zip(collision.pose.position, centre, strict=True))
    return replace(collision, pose=Pose(place, collision.pose.orientation),
                   geometry=replace(shape, scale=tuple(part * each for each in shape.scale)))


def find_tyre(link: PhysicsLink, collision: Collision) -> Tyre | None:
    """The tyre of a cylinder that turns about its own axis, or of a mesh round about the link's."""
    shape = collision.geometry
    if isinstance(shape, Mesh):
        return _of_mesh(link, collision) if _turns(link) else None
    if not isinstance(shape, Cylinder) or not _turns(link) or not _is_centred(link, collision):
        return None
    own = rotate(collision.pose.orientation, (0.0, 0.0, 1.0))
    if abs(_unit_axis(link) @ own) <= ALONG:
        return None
    return Tyre(shape.radius, shape.length, collision.pose)


def rolls(link: PhysicsLink, collision: Collision) -> bool:
    """Whether the link turns about an axis through the middle of the collision."""
    return _turns(link) and (
        _is_centred(link, collision) or find_tyre(link, collision) is not None)


def _is_centred(link: PhysicsLink, collision: Collision) -> bool:
    axis, centre = _unit_axis(link), np.array(collision.pose.position)
    return float(np.linalg.norm(centre - (centre @ axis) * axis)) < CENTRED


def _turns(link: PhysicsLink) -> bool:
    return link.joint is not None and link.joint.type in ROLLING


def _unit_axis(link: PhysicsLink) -> np.ndarray:
    return np.array(link.joint.axis) / np.linalg.norm(link.joint.axis)


def _of_mesh(link: PhysicsLink, collision: Collision) -> Tyre | None:
    try:
        vertices, _ = collision_mesh(collision.geometry)
    except FormatError:  # reported where the shape is made
        return None
    axis = _unit_axis(link)
    points = vertices @ rotation_matrix(collision.pose.orientation).T + collision.pose.position
    along, across = points @ axis, points @ _perpendicular(axis).T
    distance = np.linalg.norm(across, axis=1)
    radius = float(distance.max())
    angles = np.linspace(0.0, 2.0 * math.pi, DIRECTIONS, endpoint=False)
    outline = (across @ np.stack((np.cos(angles), np.sin(angles)))).max(axis=0)
    if radius == 0.0 or outline.min() < ROUND * radius:
        return None
    rim = along[distance > RIM * radius]
    middle = tuple(float(part) for part in 0.5 * (rim.min() + rim.max()) * axis)
    return Tyre(radius, float(np.ptp(along)), Pose(middle, _turned_to(axis)))


def _perpendicular(axis: np.ndarray) -> np.ndarray:
    """Two unit vectors perpendicular to an axis and to each other, (2, 3)."""
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    return np.stack((first, np.cross(axis, first)))


def _turned_to(axis: np.ndarray) -> Quaternion:
    """The rotation of z to a unit vector."""
    x, y, z = (float(part) for part in axis)
    if z < 0.0:  # a tread has no sides: the shorter rotation
        x, y, z = -x, -y, -z
    length = math.sqrt(2.0 * (1.0 + z))
    return (-y / length, x / length, 0.0, length / 2.0)

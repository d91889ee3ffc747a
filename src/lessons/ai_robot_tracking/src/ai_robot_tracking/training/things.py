"""Random objects of the detector's five classes, each in its own frame.

Frames: x forward (the side that faces the camera), z up, the floor at z = 0. Lengths in m.

Their parts are triangle meshes, placed and coloured.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ai_robot_tracking.training.patterns import any_colour, any_red, pattern, stop_face
from bullet_sim.description import Box, Cylinder, Material, Plane, Sphere
from bullet_sim.meshes.part import MeshPart, flat_shaded, grid_faces
from bullet_sim.pose import Pose, Vector3
from bullet_sim.rendering.primitives import primitive_part
from bullet_sim.rendering.scene import LinkShape

ROUND_SIDES = 32
Rgb = tuple[float, float, float]  # each 0..1
Images = dict[str, np.ndarray]  # textures by name, as in scenes
_numbers = itertools.count()


@dataclass(frozen=True)
class Thing:
    """One object in a world: the parts inside its box, and those that only hold it up."""

    label: str | None  # one of CLASSES; None: scenery
    own: tuple[MeshPart, ...]
    support: tuple[MeshPart, ...]
    pose: Pose
    reach: float  # m, radius of the circle on the floor that it occupies


def coloured(colour: Rgb, glow: float = 0.0, texture: str | None = None) -> Material:
    """A matt surface; `glow` is the share of the colour that needs no light."""
    rgba = (*colour, 1.0)
    glowing = (*(glow * channel for channel in colour), 1.0)
    return Material(ambient=rgba, diffuse=rgba, emissive=glowing, texture=texture)


def covered(images: Images, image: np.ndarray) -> Material:
    """A surface that shows this image, which is added to `images`.

    Renderers cache a texture by name, until its size changes: no other world has the name.
    """
    name = f"image {next(_numbers)}"
    images[name] = image
    return coloured((1.0, 1.0, 1.0), texture=name)


def box(size: Vector3, at: Vector3, material: Material, rpy: Vector3 = (0, 0, 0)) -> MeshPart:
    """A cuboid with its centre at `at` (m), rotated by roll, pitch and yaw (rad)."""
    return _placed(primitive_part(Box(size)), at, rpy, material)


def plane(side: float, height: float, material: Material) -> MeshPart:
    """A square that faces up, at a height (m)."""
    return _placed(primitive_part(Plane((0.0, 0.0, 1.0), (side, side))), (0.0, 0.0, height),
                   (0, 0, 0), material)


def bar(
    radius: float, length: float, at: Vector3, material: Material, rpy: Vector3 = (0, 0, 0)
) -> MeshPart:
    """A cylinder along z with its centre at `at`."""
    return _placed(primitive_part(Cylinder(radius, length)), at, rpy, material)


def ball(
    radius: float, at: Vector3, material: Material, stretch: Vector3 = (1, 1, 1)
) -> MeshPart:
    """A sphere, stretched along the axes."""
    part = primitive_part(Sphere(radius))
    part = replace(part, vertices=(part.vertices * stretch).astype(np.float32))
    return _placed(part, at, (0, 0, 0), material)


def frustum(low: float, high: float, bottom: float, top: float, material: Material) -> MeshPart:
    """The side of a cone about z, with radii `low`, `high` (m) at heights `bottom`, `top` (m)."""
    turn = np.linspace(0, 2 * math.pi, ROUND_SIDES + 1)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    rings = [np.column_stack([circle * radius, np.full(len(turn), height)])
             for radius, height in ((low, bottom), (high, top))]
    slope = (low - high) / (top - bottom)
    normals = np.column_stack([circle, np.full(len(turn), slope)]) / math.hypot(1, slope)
    return MeshPart(np.concatenate(rings).astype(np.float32),
                    np.concatenate([normals, normals]).astype(np.float32),
                    None, grid_faces(2, len(turn)).astype(np.uint32), material)


def plate(sides: int, radius: float, at: Vector3, front: Material, back: Material
          ) -> tuple[MeshPart, MeshPart]:
    """A thin regular polygon that faces +x, with a flat side up; its front shows the whole image.

    `radius` (m) is to the corners. The front's image is as wide and high as the plate.
    """
    turn = 2 * math.pi * (np.arange(sides) + 0.5) / sides + math.pi / 2
    outline = np.stack([np.cos(turn), np.sin(turn)], axis=1)  # image right, image up
    span = np.abs(outline).max(axis=0)
    fan = np.stack([np.zeros(sides - 2, int), np.arange(1, sides - 1), np.arange(2, sides)], 1)
    corners = np.column_stack([np.zeros(sides), outline * radius]) + at
    uv = outline / span / 2 + 0.5
    behind = corners - (0.01 * radius, 0, 0)
    return (flat_shaded(corners, fan, uv, front), flat_shaded(behind, fan[:, ::-1], None, back))


def link_shape(parts: tuple[MeshPart, ...]) -> LinkShape:
    """The parts as one link of a scene."""
    vertices = np.concatenate([part.vertices for part in parts]).astype(float)
    centre = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    return LinkShape(parts, centre, float(np.linalg.norm(vertices - centre, axis=1).max()))


def _placed(part: MeshPart, at: Vector3, rpy: Vector3, material: Material) -> MeshPart:
    matrix = Pose.from_xyz_rpy(at, rpy).matrix()
    turn = matrix[:3, :3].T
    return replace(part, vertices=(part.vertices @ turn + matrix[:3, 3]).astype(np.float32),
                   normals=(part.normals @ turn).astype(np.float32), material=material)


SKIN = ((0.96, 0.80, 0.69), (0.87, 0.67, 0.53), (0.72, 0.50, 0.36), (0.45, 0.29, 0.20),
        (0.30, 0.19, 0.13))
HAIR = ((0.08, 0.06, 0.05), (0.25, 0.15, 0.08), (0.55, 0.40, 0.18), (0.6, 0.6, 0.6))
LAMPS = ((1.0, 0.1, 0.05), (1.0, 0.75, 0.05), (0.1, 1.0, 0.35))  # red, yellow, green
ORANGE = (1.0, 0.38, 0.02)


def person(rng: np.random.Generator, images: Images) -> Thing:
    """Standing or walking, from a child to a tall man, or as small as on a model railway."""
    high = rng.uniform(1.5, 1.95) if rng.random() < 0.65 else rng.uniform(0.25, 1.5)
    top, trousers = coloured(any_colour(rng)), coloured(any_colour(rng))
    skin = coloured(SKIN[rng.integers(len(SKIN))])
    wide, leg, torso = rng.uniform(0.85, 1.25), 0.47 * high, 0.34 * high
    parts = [_trunk(rng, top, high, wide, leg, torso)]
    parts += _limbs(rng, high, wide, (top, trousers, skin))
    parts += _head(rng, high, leg + torso, skin)
    return Thing("person", tuple(parts), (), Pose(), 0.3 * high)


def _limbs(rng, high: float, wide: float, clothes: tuple[Material, ...]) -> list[MeshPart]:
    """Two legs, and usually two arms, which swing the other way."""
    top, trousers, skin = clothes
    stride, arms = rng.uniform(0, 0.55), rng.random() < 0.85
    sleeve = top if rng.random() < 0.7 else skin
    parts = []
    for side in (1, -1):
        swing = side * stride
        hip = (0, side * 0.06 * high * wide, 0.47 * high)
        parts.append(_limb(0.048 * high * wide, 0.47 * high, hip, swing, trousers))
        if arms:
            shoulder = (0, side * 0.135 * high * wide, 0.79 * high)
            parts.append(_limb(0.03 * high, 0.4 * high, shoulder,
                               -swing * rng.uniform(0.5, 1.3), sleeve))
    return parts


def _head(rng, high: float, shoulder: float, skin: Material) -> list[MeshPart]:
    """A head with its neck, and usually hair or a cap."""
    radius = 0.065 * high
    middle = shoulder + 1.45 * radius
    parts = [bar(0.03 * high, 0.06 * high, (0, 0, shoulder + 0.01 * high), skin),
             ball(radius, (0.0, 0.0, middle), skin, (0.95, 0.9, 1.2))]
    if rng.random() < 0.8:
        hair = coloured(HAIR[rng.integers(len(HAIR))] if rng.random() < 0.7 else any_colour(rng))
        parts.append(ball(1.05 * radius, (-0.25 * radius, 0, middle + 0.3 * radius), hair,
                          (1, 0.95, 1)))
    return parts


def _trunk(rng, top: Material, high: float, wide: float, leg: float, torso: float) -> MeshPart:
    at = (0.0, 0.0, leg + torso / 2)
    if rng.random() < 0.5:
        return box((0.13 * high, 0.22 * high * wide, torso), at, top)
    return ball(torso / 2, at, top, (0.13 * high / torso, 0.24 * high * wide / torso, 1.06))


def _limb(radius: float, length: float, joint: tuple, swing: float, material: Material) -> MeshPart:
    """A limb that hangs from its joint, swung forward by an angle (rad)."""
    middle = (joint[0] + math.sin(swing) * length / 2, joint[1],
              joint[2] - math.cos(swing) * length / 2)
    return bar(radius, length, middle, material, (0, -swing, 0))


def cylinder(rng: np.random.Generator, images: Images) -> Thing:
    """A plain, striped or patterned cylinder, usually upright."""
    radius = rng.uniform(0.05, 0.45)
    length = min(radius * rng.uniform(1.2, 6.0), 1.9)
    if rng.random() < 0.1:
        material = covered(images, pattern(rng))
    elif rng.random() < 0.35:
        material = coloured(any_red(rng))
    else:
        material = coloured(any_colour(rng, saturated=rng.random() < 0.7))
    if rng.random() < 0.94:
        return Thing("cylinder", (bar(radius, length, (0, 0, length / 2), material),), (), Pose(),
                     radius)
    lying = bar(radius, length, (0, 0, radius), material, (math.pi / 2, 0, 0))
    return Thing("cylinder", (lying,), (), Pose(), max(radius, length / 2))


def cone(rng: np.random.Generator, images: Images) -> Thing:
    """A traffic cone with bands and a foot, or a bare cone."""
    high = rng.uniform(0.2, 1.0)
    wide = high * rng.uniform(0.17, 0.36)
    tip = wide * rng.uniform(0.0, 0.22)
    body = coloured(ORANGE if rng.random() < 0.5 else any_colour(rng, saturated=True))
    band = coloured((0.95, 0.95, 0.95) if rng.random() < 0.85 else any_colour(rng))
    count = int(rng.integers(0, 3))
    edges = np.linspace(0, 1, 2 * count + 2) if count else np.array([0.0, 1.0])
    edges[1:-1] += rng.uniform(-0.05, 0.05, len(edges) - 2)
    parts = []
    for number, (low, above) in enumerate(pairwise(edges)):
        radii = [wide + (tip - wide) * share for share in (low, above)]
        parts.append(frustum(*radii, low * high, above * high, band if number % 2 else body))
    if tip > 0:
        parts.append(bar(tip, 0.002, (0, 0, high), body))
    if rng.random() < 0.65:
        side = 2 * wide * rng.uniform(1.1, 1.4)
        foot = body if rng.random() < 0.6 else coloured((0.08, 0.08, 0.08))
        parts.append(box((side, side, 0.05 * high), (0, 0, 0.025 * high), foot))
    return Thing("cone", tuple(parts), (), Pose(), 1.5 * wide)


def stop_sign(rng: np.random.Generator, images: Images) -> Thing:
    """A red octagon with its word, on a post; the post is not boxed."""
    radius = rng.uniform(0.2, 0.42) if rng.random() < 0.7 else rng.uniform(0.04, 0.2)
    high = radius * rng.uniform(2.0, 7.5)
    front = covered(images, stop_face(rng))
    grey = coloured((0.5, 0.5, 0.52))
    own = plate(8, radius, (0.12 * radius, 0, high), front, grey)
    return Thing("stop sign", own, (post(rng, radius, high),), Pose(), radius)


def post(rng: np.random.Generator, radius: float, high: float) -> MeshPart:
    """A post for a sign of this radius."""
    material = coloured(any_colour(rng) if rng.random() < 0.3 else (0.55, 0.55, 0.57))
    thick = radius * rng.uniform(0.06, 0.1)
    if rng.random() < 0.5:
        return bar(thick, high, (0, 0, high / 2), material)
    return box((2 * thick, 2 * thick, high), (0, 0, high / 2), material)


def traffic_light(rng: np.random.Generator, images: Images) -> Thing:
    """Three lamps, usually one of them lit, in a housing on a post or hanging."""
    wide = rng.uniform(0.2, 0.4) if rng.random() < 0.7 else rng.uniform(0.05, 0.2)
    pitch, lamp = wide * rng.uniform(0.85, 1.05), wide * rng.uniform(0.3, 0.42)
    long = 3 * pitch + 0.1 * wide
    lying = rng.random() < 0.15
    middle = rng.uniform(0.5, 4.0) * long + long / 2
    shell = coloured(_HOUSINGS[rng.integers(len(_HOUSINGS))])
    sides = (long, wide) if lying else (wide, long)
    parts = [box((0.6 * wide, *sides), (0, 0, middle), shell)]
    lit = int(rng.integers(-1, 3)) if rng.random() < 0.3 else int(rng.integers(0, 3))
    for number, colour in enumerate(LAMPS):
        place = (1 - number) * pitch
        at = (0.3 * wide, place if lying else 0, middle + (0 if lying else place))
        bright = number == lit
        shade = colour if bright else tuple(0.28 * channel for channel in colour)
        parts.append(bar(lamp, 0.06 * wide, at, coloured(shade, 0.9 if bright else 0.0),
                         (0, math.pi / 2, 0)))
        if rng.random() < 0.5:
            parts.append(box((0.35 * wide, 2.1 * lamp, 0.05 * wide),
                             (at[0] + 0.17 * wide, at[1], at[2] + lamp), shell))
    return Thing("traffic light", tuple(parts), (post(rng, wide, middle - long / 2),), Pose(),
                 max(sides[0] / 2, 0.4 * wide))


_HOUSINGS = ((0.03, 0.03, 0.03), (0.1, 0.1, 0.11), (0.05, 0.09, 0.06), (0.85, 0.65, 0.05),
             (0.35, 0.36, 0.38))
MAKERS: dict[str, Callable[[np.random.Generator, Images], Thing]] = {
    "person": person,
    "cylinder": cylinder,
    "cone": cone,
    "stop sign": stop_sign,
    "traffic light": traffic_light,
}
FACING = frozenset({"stop sign", "traffic light"})  # recognisable only from the front

"""Triangle meshes of the parts of people, cones and signs, placed and coloured."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bullet_sim.description import Box, Cylinder, Material, Sphere
from bullet_sim.meshes.part import MeshPart, flat_shaded
from bullet_sim.pose import Pose, Vector3
from bullet_sim.rendering.primitives import primitive_part
from bullet_sim.rendering.scene import LinkShape

ROUND_SIDES = 32
Rgb = tuple[float, float, float]  # each 0..1


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


def box(size: Vector3, at: Vector3, material: Material, rpy: Vector3 = (0, 0, 0)) -> MeshPart:
    """A cuboid with its centre at `at` (m), rotated by roll, pitch and yaw (rad)."""
    return _placed(primitive_part(Box(size)), at, rpy, material)


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
    column = np.arange(ROUND_SIDES)
    above = column + len(turn)
    faces = np.concatenate([np.stack([column, column + 1, above + 1], 1),
                            np.stack([column, above + 1, above], 1)])
    return MeshPart(np.concatenate(rings).astype(np.float32),
                    np.concatenate([normals, normals]).astype(np.float32),
                    None, faces.astype(np.uint32), material)


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
    return MeshPart(
        vertices=(part.vertices @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32),
        normals=(part.normals @ matrix[:3, :3].T).astype(np.float32),
        uv=part.uv,
        faces=part.faces,
        material=material,
    )

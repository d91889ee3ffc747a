"""Boxes, cylinders, spheres and planes as triangles with normals and image coordinates."""

import math

import numpy as np

from bullet_sim.description import Box, Cylinder, Plane, Sphere
from bullet_sim.meshes.part import MeshPart, grid_faces, join_parts
from bullet_sim.pose import Vector3

CYLINDER_SEGMENTS = 32
SPHERE_SEGMENTS = 32
SPHERE_RINGS = 16
# llvmpipe's depth is off by up to 200/2**24 on a triangle of 100 m, and by 6/2**24 on these cells.
PLANE_CELL = 10.0  # m
PLANE_CELLS = 32  # at most, along a side


def primitive_part(shape: Box | Cylinder | Sphere | Plane) -> MeshPart:
    """Triangles of a primitive in its own frame."""
    if isinstance(shape, Box):
        return box(shape.size)
    if isinstance(shape, Cylinder):
        return cylinder(shape.radius, shape.length)
    if isinstance(shape, Sphere):
        return sphere(shape.radius)
    return plane(shape.normal, shape.size)


def box(size: Vector3) -> MeshPart:
    """Each face shows the whole image: upright (+z) on the sides, up = +y on the top and bottom."""
    faces = [  # outward normal, image right, image up
        ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
        ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
        ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
        ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
        ((0, 0, -1), (-1, 0, 0), (0, 1, 0)),
    ]
    half = np.array(size) / 2
    corners, normals = [], []
    for normal, right, up in np.array(faces, float):
        corners += [(normal + s * right + t * up) * half for s, t in _SQUARE]
        normals += [normal] * 4
    uv = np.tile((np.array(_SQUARE) + 1) / 2, (6, 1))
    return _part(corners, normals, uv, _quads(6))


def plane(normal: Vector3, size: tuple[float, float]) -> MeshPart:
    """A rectangle seen from its normal's side; for normal +z image right is +x and up is +y."""
    up_axis = np.array(normal, float)
    up_axis /= np.linalg.norm(up_axis) or 1.0
    right = np.cross((0.0, 1.0, 0.0), up_axis)
    if np.linalg.norm(right) < 1e-6:
        right = np.array([1.0, 0.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(up_axis, right)
    cells = [min(max(2, math.ceil(side / PLANE_CELL)), PLANE_CELLS) for side in size]
    u, v = np.meshgrid(np.linspace(0, 1, cells[0] + 1), np.linspace(0, 1, cells[1] + 1))
    uv = np.stack([u, v], axis=-1).reshape(-1, 2)
    corners = (uv - 0.5) * size @ np.stack([right, up])
    faces = grid_faces(cells[1] + 1, cells[0] + 1)
    return _part(corners, np.tile(up_axis, (len(uv), 1)), uv, faces)


def cylinder(radius: float, length: float) -> MeshPart:
    """Along z, centred; the image goes once round the side and is whole on each end."""
    turn = np.linspace(0, 2 * math.pi, CYLINDER_SEGMENTS + 1)
    circle = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
    half = np.array([0, 0, length / 2])
    side = np.concatenate([circle * radius - half, circle * radius + half])
    along = np.linspace(0, 1, len(turn))
    side_uv = np.concatenate([np.stack([along, np.full_like(along, v)], 1) for v in (0, 1)])
    parts = [_part(side, np.tile(circle, (2, 1)), side_uv, grid_faces(2, CYLINDER_SEGMENTS + 1))]
    for sign in (1, -1):
        rim = circle[:-1] * radius + sign * half
        corner = np.arange(1, CYLINDER_SEGMENTS - 1)
        fan = np.stack([np.zeros_like(corner), corner, corner + 1], axis=1)[:, ::sign]
        cap_uv = circle[:-1, :2] * (sign / 2, 0.5) + 0.5
        parts.append(_part(rim, np.tile((0, 0, sign), (len(rim), 1)), cap_uv, fan))
    return join_parts(parts)


def sphere(radius: float) -> MeshPart:
    """The image goes once round, its upper edge at the north pole."""
    turn, fall = np.meshgrid(
        np.linspace(0, 2 * math.pi, SPHERE_SEGMENTS + 1),
        np.linspace(math.pi, 0, SPHERE_RINGS + 1),
    )
    normals = np.stack(
        [np.sin(fall) * np.cos(turn), np.sin(fall) * np.sin(turn), np.cos(fall)], axis=-1
    ).reshape(-1, 3)
    uv = np.stack([turn / (2 * math.pi), 1 - fall / math.pi], axis=-1).reshape(-1, 2)
    faces = grid_faces(SPHERE_RINGS + 1, SPHERE_SEGMENTS + 1).reshape(
        SPHERE_RINGS, SPHERE_SEGMENTS, 2, 3)
    caps = [faces[0, :, 1], faces[-1, :, 0]]  # at a pole one triangle of each pair has no area
    faces = np.concatenate([*caps, faces[1:-1].reshape(-1, 3)])
    return _part(normals * radius, normals, uv, faces)


_SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]  # counter-clockwise from the image's lower left


def _quads(count: int) -> np.ndarray:
    start = np.arange(count)[:, None, None] * 4
    return (start + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)


def _part(vertices, normals, uv, faces) -> MeshPart:
    return MeshPart(
        vertices=np.array(vertices, np.float32).reshape(-1, 3),
        normals=np.array(normals, np.float32).reshape(-1, 3),
        uv=np.array(uv, np.float32).reshape(-1, 2),
        faces=np.array(faces, np.uint32).reshape(-1, 3),
    )

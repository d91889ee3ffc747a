"""One drawable piece of a surface: triangles that share a material."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bullet_sim.description import Material


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles, counter-clockwise seen from outside. Arrays are read, never written."""

    vertices: np.ndarray  # (n, 3) float32, m
    normals: np.ndarray  # (n, 3) float32, unit length
    uv: np.ndarray | None  # (n, 2) float32, (0, 0) is the lower left corner of the image
    faces: np.ndarray  # (m, 3) uint32
    material: Material | None = None  # None: the file names none
    casts_shadows: bool = True
    # (k, 4, 8): homogeneous corners of boxes, together around all of it, where somebody needs them
    boxes: np.ndarray = field(default_factory=lambda: np.empty((0, 4, 8)))


NamedPart = tuple[str, MeshPart]  # name of the submesh it belongs to, and the part


def flat_shaded(
    vertices: np.ndarray,
    faces: np.ndarray,
    uv: np.ndarray | None = None,
    material: Material | None = None,
) -> MeshPart:
    """A part with one normal per triangle, from the triangle's winding; corners are not shared."""
    corners = np.asarray(vertices, np.float64)[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(length > 0, length, 1)
    count = len(faces) * 3
    return MeshPart(
        vertices=corners.reshape(count, 3).astype(np.float32),
        normals=np.repeat(normals, 3, axis=0).astype(np.float32),
        uv=None if uv is None else np.asarray(uv)[faces].reshape(count, 2).astype(np.float32),
        faces=np.arange(count, dtype=np.uint32).reshape(-1, 3),
        material=material,
    )


def join_parts(parts: Sequence[MeshPart]) -> MeshPart:
    """All triangles as one part, in order, with what else the first one has."""
    if len(parts) == 1:
        return parts[0]
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    faces = [
        part.faces + np.uint32(offset) for part, offset in zip(parts, offsets, strict=True)
    ]
    uv = None
    if any(part.uv is not None for part in parts):
        uv = np.concatenate([
            np.zeros((len(part.vertices), 2), np.float32) if part.uv is None else part.uv
            for part in parts
        ])
    return MeshPart(
        vertices=np.concatenate([part.vertices for part in parts]),
        normals=np.concatenate([part.normals for part in parts]),
        uv=uv,
        faces=np.concatenate(faces),
        material=parts[0].material,
        casts_shadows=parts[0].casts_shadows,
        boxes=np.concatenate([part.boxes for part in parts]),
    )


def box_corners(part: MeshPart, thinnest: float = 0.0) -> np.ndarray:
    """(4, 8) homogeneous corners of the box around a part, along its axes."""
    low, high = part.vertices.min(axis=0).astype(float), part.vertices.max(axis=0)
    grow = np.maximum(thinnest - (high - low), 0.0) / 2
    picks = np.indices((2, 2, 2)).reshape(3, 8)
    bounds = np.array([low - grow, high + grow])
    return np.vstack([bounds[picks[axis], axis] for axis in range(3)] + [np.ones(8)])


def grid_faces(rows: int, columns: int) -> np.ndarray:
    """(n, 3) triangles of a grid of vertices, row by row; counter-clockwise if rows follow up."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns + 1, a + columns
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)

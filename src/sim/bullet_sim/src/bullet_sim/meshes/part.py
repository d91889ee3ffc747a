"""A drawable part of a surface: triangles that share a material."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from bullet_sim.description import Material


@dataclass(frozen=True, eq=False)
class MeshPart:
    """Triangles, counter-clockwise seen from outside. Arrays are never written to."""

    vertices: np.ndarray  # (n, 3) float32, m
    normals: np.ndarray  # (n, 3) float32, unit length
    uv: np.ndarray | None  # (n, 2) float32, (0, 0) is the lower left corner of the image
    faces: np.ndarray  # (m, 3) uint32
    material: Material | None = None  # None: the file gives none
    casts_shadows: bool = True
    # (k, 4, 8): homogeneous corners of boxes that together enclose the part, if needed
    boxes: np.ndarray = field(default_factory=lambda: np.empty((0, 4, 8)))


# Odd numbers without a pattern, by which rows are multiplied for a 64-bit key.
_ODD = np.array([0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB, 0xD6E8FEB86659FD93,
                 0xA0761D6478BD642F, 0xE7037ED1A0B428DB, 0x8EBC6AF09C88C6E3, 0x589965CC75374CC3],
                np.uint64)

NamedPart = tuple[str, MeshPart]  # name of the submesh it belongs to, and the part


def flat_shaded(
    vertices: np.ndarray,
    faces: np.ndarray,
    uv: np.ndarray | None = None,
    material: Material | None = None,
) -> MeshPart:
    """A part with one normal per triangle, from the triangle's winding; corners are not shared."""
    corners = np.asarray(vertices, np.float64)[faces]
    normals = face_normals(corners)
    count = len(faces) * 3
    return MeshPart(
        vertices=corners.reshape(count, 3).astype(np.float32),
        normals=np.repeat(normals, 3, axis=0).astype(np.float32),
        uv=None if uv is None else np.asarray(uv)[faces].reshape(count, 2).astype(np.float32),
        faces=np.arange(count, dtype=np.uint32).reshape(-1, 3),
        material=material,
    )


def shaded(vertices: np.ndarray, normals: np.ndarray, faces: np.ndarray, uv: np.ndarray | None,
           material: Material | None) -> MeshPart:
    """A part with normals (n, 3) of any length for its corners (n, 3); equal ones are
    shared."""
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return welded(MeshPart(
        vertices=vertices.astype(np.float32),
        normals=(normals / np.where(length > 0, length, 1)).astype(np.float32),
        uv=uv,
        faces=faces,
        material=material,
    ))


def face_normals(corners: np.ndarray) -> np.ndarray:
    """(m, 3), unit length, from the winding of triangles (m, 3, 3); zero for one without area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / np.where(length > 0, length, 1)


def welded(part: MeshPart) -> MeshPart:
    """The same, with corners shared that are equal in everything: each is lit once."""
    uv = np.empty((len(part.vertices), 0), np.float32) if part.uv is None else part.uv
    kept, index = equal_rows(np.hstack([part.vertices, part.normals, uv]))
    return replace(part, vertices=part.vertices[kept], normals=part.normals[kept],
                   uv=None if part.uv is None else part.uv[kept], faces=index[part.faces])


def equal_rows(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The first of each of the rows (n, k up to 8) float32, in order, and for each row (n,) uint32
    its index there. Uses a key per row: numpy's unique of rows takes ten times as long."""
    rows = np.ascontiguousarray(rows, np.float32) + np.float32(0.0)  # makes -0 0
    key = rows.view(np.uint32).astype(np.uint64) @ _ODD[:rows.shape[1]]
    _, kept, index = np.unique(key, return_index=True, return_inverse=True)
    if not np.array_equal(rows[kept][index.reshape(-1)], rows):  # different rows with one key
        _, kept, index = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(kept)
    place = np.empty(len(order), np.uint32)
    place[order] = np.arange(len(order))
    return kept[order], place[index.reshape(-1)]


def join_parts(parts: Sequence[MeshPart]) -> MeshPart:
    """All triangles as one part, in order, with the other fields of the first one."""
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
    """(n, 3) triangles of a grid of vertices, row by row; counter-clockwise if rows go upwards."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column
    b, c, d = a + 1, a + columns + 1, a + columns
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)

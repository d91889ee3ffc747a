"""Triangles of mesh files: loaded once, scaled, with the materials that the file itself names."""

from __future__ import annotations

import functools
import logging
import os
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bullet_sim.description import Mesh
from bullet_sim.errors import FormatError
from bullet_sim.mesh_collada import read_collada
from bullet_sim.mesh_part import MeshPart, NamedPart
from bullet_sim.mesh_stl import read_stl
from bullet_sim.mesh_wavefront import read_wavefront

__all__ = ["MeshPart", "collision_mesh", "load_mesh", "to_obj"]

_trimesh_log = logging.getLogger("trimesh")
_trimesh_log.addHandler(logging.NullHandler())
_trimesh_log.propagate = False  # a learner's terminal shows our own warning, once


@dataclass(frozen=True)
class _FileVersion:
    """What a cached mesh depends on: a file written again is read again."""

    geometry: Mesh
    modified_ns: int


def load_mesh(geometry: Mesh) -> tuple[MeshPart, ...]:
    """Parts of an STL, DAE or OBJ file, one per material, in the mesh's own frame and in metres."""
    try:
        modified_ns = os.stat(geometry.path).st_mtime_ns
    except OSError as error:
        raise FormatError(f"mesh {geometry.path} cannot be read: {error.strerror}") from None
    return _load(_FileVersion(geometry, modified_ns))


def collision_mesh(geometry: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """All triangles: vertices (n, 3) float32 in m, equal ones merged, and faces (m, 3) uint32."""
    parts = load_mesh(geometry)
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    vertices = np.concatenate([part.vertices for part in parts])
    faces = np.concatenate([
        part.faces + np.uint32(offset) for part, offset in zip(parts, offsets, strict=True)
    ])
    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    faces = index.reshape(-1)[faces].astype(np.uint32)
    has_area = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return unique, faces[has_area]


def to_obj(geometry: Mesh, folder: Path | str) -> Path:
    """Write the collision triangles as plain OBJ into `folder`; equal meshes, equal names."""
    vertices, faces = collision_mesh(geometry)
    key = f"{geometry.path}|{geometry.scale}|{geometry.submesh}|{geometry.centre_submesh}"
    path = Path(folder) / f"{Path(geometry.path).stem}-{_short_hash(key)}.obj"
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def _short_hash(text: str) -> str:
    value = 0
    for byte in text.encode():
        value = (value * 1000003 ^ byte) & 0xFFFFFFFFFFFF
    return f"{value:012x}"


@functools.lru_cache(maxsize=256)
def _load(version: _FileVersion) -> tuple[MeshPart, ...]:
    geometry = version.geometry
    named = _read(Path(geometry.path), geometry.submesh)
    parts = [part for _, part in _chosen(named, geometry)]
    if geometry.submesh is not None and geometry.centre_submesh:
        parts = _centred(parts)
    return tuple(_scaled(part, geometry.scale) for part in parts)


def _read(path: Path, submesh: str | None) -> list[NamedPart]:
    """Named parts of a file; whatever the parser stumbles over becomes one FormatError."""
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        known = ", ".join(sorted(_READERS))
        raise FormatError(f"mesh {path}: unknown kind {path.suffix!r}; there are: {known}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the parsers' own arithmetic
            parts = reader(path, submesh is not None)
    except Exception as error:  # parsers of three libraries, each with its own exceptions
        reason = " ".join(str(error).split()) or type(error).__name__
        raise FormatError(f"mesh {path} cannot be read: {reason}") from error
    parts = [(name, part) for name, part in parts if len(part.faces)]
    if not parts:
        raise FormatError(f"mesh {path} cannot be read: it has no triangles")
    if not all(np.isfinite(part.vertices).all() for _, part in parts):
        raise FormatError(f"mesh {path} cannot be read: a vertex is not a finite number")
    return parts


def _chosen(parts: list[NamedPart], geometry: Mesh) -> list[NamedPart]:
    if geometry.submesh is None:
        return parts
    chosen = [(name, part) for name, part in parts if name == geometry.submesh]
    if not chosen:
        known = ", ".join(sorted({name for name, _ in parts}))
        raise FormatError(
            f"mesh {geometry.path} has no submesh {geometry.submesh!r}; there are: {known}"
        )
    return chosen


def _centred(parts: list[MeshPart]) -> list[MeshPart]:
    """Moved so that the middle of the bounding box is the origin."""
    low = np.min([part.vertices.min(axis=0) for part in parts], axis=0)
    high = np.max([part.vertices.max(axis=0) for part in parts], axis=0)
    middle = ((low + high) / 2).astype(np.float32)
    return [replace(part, vertices=part.vertices - middle) for part in parts]


def _scaled(part: MeshPart, scale: tuple[float, float, float]) -> MeshPart:
    """Scaled along the mesh's axes; a mirroring scale turns triangles so they still face out."""
    if scale == (1.0, 1.0, 1.0):
        return part
    x, y, z = scale
    factors = np.array(scale, np.float32)
    normals = part.normals * np.array([y * z, z * x, x * y], np.float32)
    mirrored = x * y * z < 0
    if mirrored:
        normals = -normals
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return replace(
        part,
        vertices=part.vertices * factors,
        normals=(normals / np.where(length > 0, length, 1)).astype(np.float32),
        faces=np.ascontiguousarray(part.faces[:, ::-1]) if mirrored else part.faces,
    )


_READERS = {
    ".stl": read_stl,
    ".stla": read_stl,
    ".stlb": read_stl,
    ".obj": read_wavefront,
    ".dae": read_collada,
}

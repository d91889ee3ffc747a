"""Triangles of mesh files: loaded once, scaled, with the materials named by the file itself."""

import functools
import logging
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bullet_sim.description import Generated, Material, Mesh
from bullet_sim.errors import FormatError, prefixed
from bullet_sim.files import check_file
from bullet_sim.meshes.collada import read_collada
from bullet_sim.meshes.detail import cluster
from bullet_sim.meshes.generated import generated_parts
from bullet_sim.meshes.part import MeshPart, NamedPart, join_parts
from bullet_sim.meshes.smoothing import smooth_shaded
from bullet_sim.meshes.stl import read_stl
from bullet_sim.meshes.wavefront import read_wavefront

LARGEST_PART = 200_000_000  # bytes


def read_scene(path: Path, split: bool) -> list[NamedPart]:
    """A .ply, .off, .glb or .gltf file: a part per geometry, placed as in the scene, named after
    its node, with a colour and an image.

    Gazebo Classic reads none of them; models written for newer tools use them. The coordinates
    stay: no axis is rotated, and glTF's are metres.
    """
    import trimesh
    from trimesh.resolvers import FilePathResolver

    class Beside(FilePathResolver):
        """Files named in the file: buffers and images next to it."""

        def get(self, name: str) -> bytes:
            check_file(Path(self.parent) / name, LARGEST_PART)
            return super().get(name)

    scene = trimesh.load_scene(str(path), resolver=Beside(str(path)), process=False)
    parts = []
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces):  # not points or lines
            parts.append((str(node), _part(mesh, np.asarray(matrix))))
    return parts


def _part(mesh: Any, matrix: np.ndarray) -> MeshPart:
    vertices = np.asarray(mesh.vertices) @ matrix[:3, :3].T + matrix[:3, 3]
    faces = np.asarray(mesh.faces)
    if np.linalg.det(matrix[:3, :3]) < 0:
        faces = faces[:, ::-1]
    return smooth_shaded(vertices, faces, getattr(mesh.visual, "uv", None), _material(mesh))


def _material(mesh: Any) -> Material | None:
    """The base colour of a glTF surface; None if there is none."""
    colour = getattr(getattr(mesh.visual, "material", None), "baseColorFactor", None)
    if colour is None:
        return None
    red, green, blue, alpha = (float(channel) / 255 for channel in colour)
    return Material(ambient=(red, green, blue, 1.0), diffuse=(red, green, blue, alpha))


__all__ = ["MeshPart", "collision_mesh", "load_mesh"]

LARGEST_FILE = 200_000_000  # bytes; trimesh's OBJ reader takes about 20 times as much memory
MOST_DRAWN = 300_000  # triangles of one file; more make the camera slow
MOST_COLLIDING = 60_000  # triangles of one file; with a million the engine takes ten seconds

_log = logging.getLogger(__name__)
_trimesh_log = logging.getLogger("trimesh")
_trimesh_log.addHandler(logging.NullHandler())
_trimesh_log.propagate = False  # a learner's terminal shows our own warning, once


def load_mesh(geometry: Mesh | Generated) -> tuple[MeshPart, ...]:
    """Parts of a file, one per material, in the mesh's own frame and in metres.

    A file with very many triangles is drawn with fewer (`MOST_DRAWN`), with one warning.
    FormatError for a file that cannot be read or has no triangles.
    """
    if not isinstance(geometry, Mesh):
        return generated_parts(geometry)
    with prefixed("mesh"):
        status = check_file(geometry.path, LARGEST_FILE, "export it with fewer triangles")
    return _load(geometry, status.st_mtime_ns)


def collision_mesh(geometry: Mesh | Generated) -> tuple[np.ndarray, np.ndarray]:
    """The triangles: vertices (n, 3) float32 in m, equal ones merged, and faces (m, 3) uint32.

    With more than `MOST_COLLIDING`, that many that stay close to them.

    FormatError for a file that cannot be read.
    """
    whole = join_parts(load_mesh(geometry))
    vertices, faces = whole.vertices, whole.faces
    if len(faces) > MOST_COLLIDING:
        kept, faces = cluster(vertices, faces, MOST_COLLIDING)
        return vertices[kept], faces
    unique, index = np.unique(vertices, axis=0, return_inverse=True)
    faces = index.reshape(-1)[faces].astype(np.uint32)
    has_area = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return unique, faces[has_area]


@functools.lru_cache(maxsize=256)
def _load(geometry: Mesh, _modified_ns: int) -> tuple[MeshPart, ...]:
    """Cached by the mesh and its file's modification time: a changed file is read again."""
    named = _read(Path(geometry.path), geometry.submesh)
    parts = [part for _, part in _chosen(named, geometry)]
    if geometry.submesh is not None and geometry.centre_submesh:
        parts = _centred(parts)
    parts = _with_fewer_triangles(parts, geometry.path)
    return tuple(_scaled(part, geometry.scale) for part in parts)


def _read(path: Path, submesh: str | None) -> list[NamedPart]:
    """Named parts of a file; any error of the parser becomes one FormatError."""
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        known = ", ".join(sorted(_READERS))
        raise FormatError(f"mesh {path}: unknown kind {path.suffix!r}; there are: {known}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # from the parsers' own arithmetic
            parts = reader(path, submesh is not None)
    except Exception as error:  # three libraries' parsers, each with its own exceptions
        raise FormatError(f"mesh {path} cannot be read: {_reason(error)}") from error
    parts = [(name, part) for name, part in parts if len(part.faces)]
    if not parts:
        raise FormatError(f"mesh {path} cannot be read: it has no triangles")
    if not all(np.isfinite(part.vertices).all() for _, part in parts):
        raise FormatError(f"mesh {path} cannot be read: a vertex is not a finite number")
    return parts


def _reason(error: Exception) -> str:
    """One line, with advice if the parser gives none."""
    reason = " ".join(str(error).split()) or type(error).__name__
    if isinstance(error, FormatError):
        return reason
    return f"{reason}; export the file again"


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
    """Moved so that the centre of the bounding box is the origin."""
    low = np.min([part.vertices.min(axis=0) for part in parts], axis=0)
    high = np.max([part.vertices.max(axis=0) for part in parts], axis=0)
    middle = ((low + high) / 2).astype(np.float32)
    return [replace(part, vertices=part.vertices - middle) for part in parts]


def _with_fewer_triangles(parts: list[MeshPart], path: str) -> list[MeshPart]:
    count = sum(len(part.faces) for part in parts)
    if count <= MOST_DRAWN:
        return parts
    fewer = []
    for part in parts:
        kept, faces = cluster(part.vertices, part.faces, MOST_DRAWN * len(part.faces) // count)
        uv = None if part.uv is None else part.uv[kept]
        fewer.append(smooth_shaded(part.vertices[kept], faces, uv, part.material))
    fewer = [part for part in fewer if len(part.faces)]
    left = sum(len(part.faces) for part in fewer)
    _log.warning("mesh %s has %d triangles and is drawn with %d; export it with at most %d",
                 path, count, left, MOST_DRAWN)
    return fewer


def _scaled(part: MeshPart, scale: tuple[float, float, float]) -> MeshPart:
    """Scaled along the mesh's axes; mirrored triangles are reversed so that they face out."""
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
    ".glb": read_scene,
    ".gltf": read_scene,
    ".off": read_scene,
    ".ply": read_scene,
}

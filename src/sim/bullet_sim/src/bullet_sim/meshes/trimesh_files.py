"""Formats that trimesh reads as a scene: .ply, .off, .glb, .gltf. A colour and an image per part.

Gazebo Classic reads none of them; models written for newer tools use them. The coordinates stay:
no axis is rotated, and glTF's are metres.
"""

from pathlib import Path
from typing import Any

import numpy as np

from bullet_sim.description import Material
from bullet_sim.files import check_file
from bullet_sim.meshes.part import MeshPart, NamedPart
from bullet_sim.meshes.smoothing import smooth_shaded

LARGEST_PART = 200_000_000  # bytes


def read_scene(path: Path, split: bool) -> list[NamedPart]:
    """One part per geometry, placed as in the scene, and named after its node."""
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

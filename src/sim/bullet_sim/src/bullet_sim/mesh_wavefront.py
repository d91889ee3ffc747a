"""Wavefront OBJ files with the materials of their MTL file."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

import numpy as np

from bullet_sim.description import Material
from bullet_sim.mesh_part import MeshPart, NamedPart, flat_shaded


def read_wavefront(path: Path, split: bool) -> list[NamedPart]:
    """One part per material; with `split`, one per object, named as in the file."""
    from trimesh.exchange.obj import load_obj
    from trimesh.resolvers import FilePathResolver

    with path.open("rb") as file:
        loaded = load_obj(
            file,
            resolver=FilePathResolver(str(path)),
            group_material=True,
            split_objects=split,
        )
    materials = _read_materials(path)
    return [
        (_object_name(name, solid), _part(solid, materials))
        for name, solid in loaded.get("geometry", {}).items()
    ]


def _object_name(name: str, solid: dict) -> str:
    """Without the material that trimesh appends to the object's name."""
    return name.removesuffix("_" + _material_name(solid)) if _material_name(solid) else name


def _material_name(solid: dict) -> str:
    material = getattr(solid.get("visual"), "material", None)
    return getattr(material, "name", None) or ""


def _part(solid: dict, materials: dict[str, Material]) -> MeshPart:
    material = materials.get(_material_name(solid))
    uv = getattr(solid.get("visual"), "uv", None)
    vertices, faces = np.asarray(solid["vertices"]), np.asarray(solid["faces"])
    normals = solid.get("vertex_normals")
    if normals is None:
        return flat_shaded(vertices, faces, uv, material)
    return MeshPart(
        vertices=vertices.astype(np.float32),
        normals=np.asarray(normals, np.float32),
        uv=None if uv is None else np.asarray(uv, np.float32),
        faces=faces.astype(np.uint32),
        material=material,
    )


def _read_materials(path: Path) -> dict[str, Material]:
    """Colours and texture of each `newmtl` in the OBJ's library; a missing library has none."""
    library = _library_of(path)
    if library is None or not library.is_file():
        return {}
    values: dict[str, dict[str, list[str]]] = {}
    current: dict[str, list[str]] = {}
    for line in library.read_text(errors="replace").splitlines():
        key, *words = line.split() or [""]
        if key.lower() == "newmtl":
            current = values[" ".join(words)] = {}
        elif words:
            current[key.lower()] = words
    return {name: _material(entry, library.parent) for name, entry in values.items()}


def _library_of(path: Path) -> Path | None:
    with path.open(errors="replace") as lines:
        for line in lines:
            if line.startswith("mtllib"):
                return path.parent / line[len("mtllib"):].strip()
    return None


def _material(entry: dict[str, list[str]], folder: Path) -> Material:
    alpha = float(entry["d"][-1]) if "d" in entry else 1.0
    texture = _texture(entry.get("map_kd"), folder)
    diffuse = _colour(entry.get("kd"), (1.0, 1.0, 1.0) if texture else (0.7, 0.7, 0.7))
    return Material(
        # As Gazebo: exporters leave Ka black or white whatever the surface is.
        ambient=(*diffuse, 1.0),
        diffuse=(*diffuse, alpha),
        specular=(*_colour(entry.get("ks"), (0.0, 0.0, 0.0)), 1.0),
        emissive=(*_colour(entry.get("ke"), (0.0, 0.0, 0.0)), 1.0),
        shininess=float(entry["ns"][0]) if "ns" in entry else 0.0,
        texture=texture,
    )


def _colour(words: list[str] | None, default: tuple) -> tuple[float, float, float]:
    if words is None:
        return default
    red, green, blue = (float(word) for word in (words * 3 if len(words) == 1 else words)[:3])
    return (red, green, blue)


def _texture(words: list[str] | None, folder: Path) -> str | None:
    """Absolute path of `map_Kd`, whose options are skipped; a missing file is no texture."""
    if not words:
        return None
    for name in (" ".join(words), words[-1]):
        path = folder / unquote(name.replace("\\", "/"))
        if path.is_file():
            return str(path.resolve())
    return None

"""Wavefront OBJ files: polygons with any number of corners, with materials from their MTL files.

Read here and not by trimesh, which rejects polygons of four corners in a group of their own.
"""

import logging
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from bullet_sim.description import Material
from bullet_sim.errors import FormatError, shortened
from bullet_sim.files import check_file, find_beside
from bullet_sim.meshes.part import MeshPart, NamedPart, shaded
from bullet_sim.meshes.smoothing import smooth_shaded

LONGEST_FILE_NAME = 255  # characters
LARGEST_LIBRARY = 4 * 2**20  # bytes
_log = logging.getLogger(__name__)

Entry = dict[str, list[str]]  # keyword in lower case -> its words


def read_materials(path: Path, libraries: list[str]) -> dict[str, Material]:
    """All `newmtl` of the libraries named by the OBJ at `path`; a missing one is a warning.

    FormatError for impossible numbers.
    """
    values: dict[str, Entry] = {}
    for name in libraries:
        library = find_beside(name, path.parent)
        if library is None:
            _log.warning("mesh %s: material library %s not found (searched: %s)",
                         path, shortened(name, LONGEST_FILE_NAME), path.parent)
        else:
            values |= _entries(library)
    return {name: _material(entry, path) for name, entry in values.items()}


def _entries(library: Path) -> dict[str, Entry]:
    values: dict[str, Entry] = {}
    current: Entry = {}
    check_file(library, LARGEST_LIBRARY)
    for line in library.read_text(errors="replace").splitlines():
        key, *words = line.split() or [""]
        if key.lower() == "newmtl":
            current = values[" ".join(words)] = {}
        elif words:
            current[key.lower()] = words
    return values


def _material(entry: Entry, mesh: Path) -> Material:
    texture = _texture(entry.get("map_kd"), mesh)
    diffuse = _colour(entry.get("kd"), (1.0, 1.0, 1.0) if texture else (0.7, 0.7, 0.7))
    return Material(
        # Exporters leave Ka black or white whatever the surface is.
        ambient=(*diffuse, 1.0),
        diffuse=(*diffuse, _opacity(entry)),
        specular=(*_colour(entry.get("ks"), (0.0, 0.0, 0.0)), 1.0),
        emissive=(*_colour(entry.get("ke"), (0.0, 0.0, 0.0)), 1.0),
        shininess=float(entry["ns"][0]) if "ns" in entry else 0.0,
        texture=texture,
    )


def _opacity(entry: Entry) -> float:
    """`d`, or the older `Tr`, its opposite; programs that confuse them mean opaque."""
    if "d" in entry:
        return float(entry["d"][-1])
    opacity = 1.0 - float(entry["tr"][0]) if "tr" in entry else 1.0
    return opacity if opacity > 0 else 1.0


def _colour(words: list[str] | None, default: tuple) -> tuple[float, float, float]:
    if words is None:
        return default
    red, green, blue = (float(word) for word in (words * 3 if len(words) == 1 else words)[:3])
    return (red, green, blue)


def _texture(words: list[str] | None, mesh: Path) -> str | None:
    """Absolute path of `map_Kd`, whose options are skipped; a missing file is a warning."""
    if not words:
        return None
    for name in (" ".join(words), words[-1]):
        if path := find_beside(name, mesh.parent):
            return str(path.resolve())
    _log.warning("mesh %s: texture %s not found (searched: %s); drawn without it",
                 mesh, " ".join(words), mesh.parent)
    return None


LISTS = ("v", "vt", "vn")  # positions, image coordinates, normals
WIDTHS = {"v": 3, "vt": 2, "vn": 3}


@dataclass
class _Statements:
    """A file's lines by their keyword."""

    lists: dict[str, list[str]] = field(default_factory=lambda: {key: [] for key in LISTS})
    corners: dict[tuple[str, str], list[str]] = field(default_factory=dict)
    # object and material -> corners such as 7/3/5, three per triangle
    libraries: list[str] = field(default_factory=list)


def read_wavefront(path: Path, split: bool) -> list[NamedPart]:
    """One part per material; with `split`, one per object and material, named as in the file.

    FormatError for invalid indices or numbers.
    """
    statements = _statements(path, split)
    materials = read_materials(path, statements.libraries)
    arrays = {key: _array(rows, WIDTHS[key]) for key, rows in statements.lists.items()}
    return [
        (name, _part(_indices(corners), arrays, materials.get(material)))
        for (name, material), corners in statements.corners.items() if corners
    ]


def _statements(path: Path, split: bool) -> _Statements:
    found = _Statements()
    name, material = path.stem, ""
    target = found.corners.setdefault((name, material), [])
    for line in path.read_text(errors="replace").replace("\\\n", " ").splitlines():
        key, _, rest = line.strip().replace("\t", " ").partition(" ")
        if key in found.lists:
            found.lists[key].append(rest)
        elif key == "f":
            target += _triangles(rest.split(), found.lists)
        elif key in ("o", "g", "usemtl"):
            if key == "usemtl":
                material = rest.strip()
            elif split:
                name = rest.strip() or name
            target = found.corners.setdefault((name, material), [])
        elif key == "mtllib":
            found.libraries += [rest.strip()]
    return found


def _triangles(corners: list[str], lists: dict[str, list[str]]) -> Iterable[str]:
    """A polygon as a fan; indices relative to the end of the lists so far become absolute."""
    if any("-" in corner for corner in corners):
        corners = [_from_the_start(corner, lists) for corner in corners]
    if len(corners) == 3:
        return corners
    return [
        corner for second, third in pairwise(corners[1:])
        for corner in (corners[0], second, third)
    ]


def _from_the_start(corner: str, lists: dict[str, list[str]]) -> str:
    words = []
    for word, key in zip(corner.split("/"), LISTS, strict=False):
        words.append(str(len(lists[key]) + 1 + int(word)) if word.startswith("-") else word)
    return "/".join(words)


def _array(rows: list[str], width: int) -> np.ndarray:
    """(n, width) from rows that may have more columns, such as colours, or too few."""
    if not rows:
        return np.zeros((0, width))
    columns = len(rows[0].split())
    values = np.array(" ".join(rows).split(), np.float64)
    if columns < width or values.size != len(rows) * columns:
        padded = [[*row.split(), *["0"] * width][:width] for row in rows]
        return np.array(padded, np.float64)
    return values.reshape(len(rows), columns)[:, :width]


def _indices(corners: list[str]) -> np.ndarray:
    """Indices (n, 3) from 0, of position, image coordinate and normal; -1 if a corner has none."""
    text = " ".join(corners)
    first = corners[0]
    columns = first.count("/") + 1
    if "//" not in text and text.count("/") == (columns - 1) * len(corners):
        given = np.array(text.replace("/", " ").split(), np.int64).reshape(-1, columns)
        indices = np.zeros((len(corners), 3), np.int64)
        indices[:, :columns] = given
        return indices - 1
    words = [[*corner.split("/"), "", ""][:3] for corner in corners]
    return np.array([[int(word or 0) for word in row] for row in words], np.int64) - 1


def _part(
    indices: np.ndarray, arrays: dict[str, np.ndarray], material: Material | None
) -> MeshPart:
    for key, column in zip(LISTS, indices.T):
        if len(column) and column.max() >= len(arrays[key]):
            raise FormatError(f"a face asks for {key} number {column.max() + 1}, there are "
                              f"{len(arrays[key])}")
    if (indices[:, 0] < 0).any():
        raise FormatError("a face has a corner number below 1")
    position, image, normal = indices.T
    faces = np.arange(len(indices), dtype=np.uint32).reshape(-1, 3)
    vertices = arrays["v"][position]
    uv = None if (image < 0).any() else arrays["vt"][image].astype(np.float32)
    if (normal < 0).any():
        return smooth_shaded(vertices, faces, uv, material)
    normals = arrays["vn"][normal]
    return shaded(vertices, normals, faces, uv, material)

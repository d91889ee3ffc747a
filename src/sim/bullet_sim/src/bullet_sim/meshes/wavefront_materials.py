"""The materials of a Wavefront OBJ file, from its MTL libraries."""

import logging
from pathlib import Path

from bullet_sim.description import Material
from bullet_sim.errors import shortened
from bullet_sim.files import check_file, find_beside

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

"""STL files, text or binary: triangles without material.

Read here and not by trimesh, whose import takes half a second of a simulator's start (measured).
"""

import re
from itertools import zip_longest
from pathlib import Path

import numpy as np

from bullet_sim.errors import FormatError
from bullet_sim.meshes.part import MeshPart, NamedPart
from bullet_sim.meshes.smoothing import smooth_shaded

# The binary layout: 80 arbitrary bytes, the number of facets, and this for each facet.
_HEADER_BYTES = 84
_MOST_FACETS = 10**8  # a larger number is text
_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

_SOLID = re.compile(r"^[ \t]*solid\b(.*)$", re.MULTILINE | re.IGNORECASE)
_VERTEX = re.compile(r"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(path: Path, split: bool) -> list[NamedPart]:
    """One part per solid of a text file, by its name; a single one has the file's name.

    FormatError if it is not STL.
    """
    content = path.read_bytes()
    corners = _binary_corners(content)
    if corners is not None:
        return [(path.stem, _part(corners))]
    solids = _text_solids(content.decode(errors="replace"))
    if not solids:
        return [(path.stem, _part(_cut_or_padded_corners(content)))]
    if len(solids) == 1:
        return [(path.stem, _part(solids[0][1]))]
    return [(name, _part(corners)) for name, corners in solids]


def _binary_corners(content: bytes) -> np.ndarray | None:
    """Corners (n * 3, 3) if the length agrees with the header; many start with `solid`, too."""
    if len(content) < _HEADER_BYTES:
        return None
    count = int.from_bytes(content[_HEADER_BYTES - 4:_HEADER_BYTES], "little")
    if len(content) != _HEADER_BYTES + count * _FACET.itemsize:
        return None
    return np.frombuffer(content, _FACET, offset=_HEADER_BYTES)["corners"].reshape(-1, 3)


def _cut_or_padded_corners(content: bytes) -> np.ndarray:
    """As many facets as there are: some programs write a wrong number or append bytes."""
    stated = int.from_bytes(content[_HEADER_BYTES - 4:_HEADER_BYTES], "little")
    present = max(0, len(content) - _HEADER_BYTES) // _FACET.itemsize
    if not present or stated > _MOST_FACETS:
        raise FormatError("neither text nor binary STL, or empty; export the file again")
    if stated > present:
        raise FormatError(f"cut off: the header says {stated} triangles, {present} are there; "
                          "copy or export the file again")
    facets = np.frombuffer(content, _FACET, stated or present, _HEADER_BYTES)
    return facets["corners"].reshape(-1, 3)


def _text_solids(text: str) -> list[tuple[str, np.ndarray]]:
    """Name and corners (n * 3, 3) of each solid that has any."""
    solids = []
    starts = list(_SOLID.finditer(text))
    for start, following in zip_longest(starts, starts[1:]):
        end = following.start() if following else len(text)
        corners = np.array(_VERTEX.findall(text, start.end(), end), np.float64)
        if len(corners) % 3:
            raise FormatError(f"solid {start[1].strip()!r} has a facet without three corners")
        if len(corners):
            solids.append((start[1].strip(), corners))
    return solids


def _part(corners: np.ndarray) -> MeshPart:
    return smooth_shaded(corners, np.arange(len(corners)).reshape(-1, 3))

"""Triangles of the shapes that no mesh file holds: generated at first use, then cached."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from bullet_sim.description import Generated, Heightmap, ImageExtrusion, Polyline, Strip
from bullet_sim.errors import FormatError
from bullet_sim.meshes.extrusion import image_part, polyline_part, strip_part
from bullet_sim.meshes.heightmap import heightmap_parts
from bullet_sim.meshes.images import check_image
from bullet_sim.meshes.part import MeshPart


@dataclass(frozen=True)
class _Version:
    """What the triangles depend on: an image written again is read again."""

    shape: Generated
    modified_ns: int


def generated_parts(shape: Generated) -> tuple[MeshPart, ...]:
    """Parts of one material each, in the link frame; FormatError where there is nothing to see."""
    path = getattr(shape, "path", None)
    try:
        modified_ns = check_image(path).st_mtime_ns if path else 0
    except FormatError as error:
        raise FormatError(f"image {error}") from None
    parts = _made(_Version(shape, modified_ns))
    if not any(len(part.faces) for part in parts):
        raise FormatError(f"{type(shape).__name__} has no surface; give it a size and a height")
    return parts


@functools.lru_cache(maxsize=32)
def _made(version: _Version) -> tuple[MeshPart, ...]:
    match version.shape:
        case Heightmap() as shape:
            return heightmap_parts(shape)
        case ImageExtrusion() as shape:
            return (image_part(shape),)
        case Polyline() as shape:
            return (polyline_part(shape),)
        case Strip() as shape:
            return (strip_part(shape),)
    raise TypeError(f"no triangles for {version.shape!r}")

"""Triangles of shapes that are not mesh files: generated at first use, then cached."""

import functools

from bullet_sim.description import Generated, Heightmap, ImageExtrusion, Polyline, Strip
from bullet_sim.errors import FormatError, prefixed
from bullet_sim.meshes.extrusion import image_part, polyline_part, strip_part
from bullet_sim.meshes.heightmap import heightmap_parts
from bullet_sim.meshes.images import check_image
from bullet_sim.meshes.part import MeshPart


def generated_parts(shape: Generated) -> tuple[MeshPart, ...]:
    """Parts of one material each, in the link frame; FormatError if there is nothing to see."""
    path = getattr(shape, "path", None)
    with prefixed("image"):
        modified_ns = check_image(path).st_mtime_ns if path else 0
    parts = _made(shape, modified_ns)
    if not any(len(part.faces) for part in parts):
        raise FormatError(f"{type(shape).__name__} has no surface; give it a size and a height")
    return parts


@functools.lru_cache(maxsize=32)
def _made(shape: Generated, _modified_ns: int) -> tuple[MeshPart, ...]:
    """Cached by the shape and its file's modification time: a changed image is read again."""
    match shape:
        case Heightmap():
            return heightmap_parts(shape)
        case ImageExtrusion():
            return (image_part(shape),)
        case Polyline():
            return (polyline_part(shape),)
        case Strip():
            return (strip_part(shape),)
    raise TypeError(f"no triangles for {shape!r}")

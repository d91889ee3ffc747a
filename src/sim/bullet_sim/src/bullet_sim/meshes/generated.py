"""Triangles of shapes that are not mesh files: generated at first use, then cached."""

import functools
import itertools
from collections.abc import Iterable
from dataclasses import replace

import cv2
import numpy as np

from bullet_sim.description import (
    Generated,
    Heightmap,
    ImageExtrusion,
    Material,
    Polyline,
    Strip,
    TerrainLayer,
)
from bullet_sim.errors import FormatError, prefixed
from bullet_sim.meshes.images import check_image, read_image, shrunk
from bullet_sim.meshes.part import MeshPart, flat_shaded, grid_faces

MOST_POINTS = 2000  # of all outlines together: the work grows quadratically
MOST_BLOCKS = 5000  # of an image; with more, it is reduced to half its size
LARGEST_PICTURE_PX = 1024  # longest side that is used
PRISM_FACES = np.array([
    (0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7),  # bottom, top
    (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7),
])


def polyline_part(shape: Polyline) -> MeshPart:
    """The outlines as a solid on z = 0. FormatError for outlines that enclose nothing."""
    return _prisms(trapezoids(shape.outlines), shape.height)


def image_part(shape: ImageExtrusion) -> MeshPart:
    """Blocks where the image is dark; its upper edge is +y, its right edge +x.

    FormatError without a dark pixel, and as from `read_image`.
    """
    with prefixed("image"):
        image = read_image(shape.path, cv2.IMREAD_GRAYSCALE)
    pixel = shape.scale  # m
    longest = max(image.shape)
    if longest > LARGEST_PICTURE_PX:
        shrink = LARGEST_PICTURE_PX / longest
        image = shrunk(image, shrink)
        pixel /= shrink
    while len(blocks := dark_rectangles(image <= shape.threshold)) > MOST_BLOCKS:
        image = shrunk(image, 0.5)
        pixel *= 2
    if not blocks:
        raise FormatError(f"image {shape.path} has no pixel as dark as {shape.threshold}; "
                          "raise <threshold>")
    height_px, width_px = image.shape
    left, top, right, bottom = np.array(blocks, float).T
    x0, x1 = (left - width_px / 2) * pixel, (right - width_px / 2) * pixel
    y0, y1 = (height_px / 2 - bottom) * pixel, (height_px / 2 - top) * pixel
    corners = np.stack([np.stack(corner, axis=1) for corner in
                        ((x0, y0), (x1, y0), (x1, y1), (x0, y1))], axis=1)
    return _prisms(corners, shape.height)


def strip_part(shape: Strip) -> MeshPart:
    """A flat band; the image spans its width once and is repeated along it, undistorted."""
    points = np.array(shape.points, float)
    along = np.gradient(points[:, :2], axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    across = np.stack([-along[:, 1], along[:, 0], np.zeros(len(along))], axis=1)
    sides = [points + across * shape.width / 2, points - across * shape.width / 2]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    uv = [np.stack([np.full(len(way), side), way / shape.width], axis=1) for side in (0.0, 1.0)]
    left, right = np.arange(len(points) - 1), np.arange(len(points) - 1) + len(points)
    faces = np.concatenate([np.stack([left, right, right + 1], axis=1),
                            np.stack([left, right + 1, left + 1], axis=1)])
    return flat_shaded(np.concatenate(sides), faces, np.concatenate(uv))


def trapezoids(outlines: Iterable[Iterable[tuple[float, float]]]) -> np.ndarray:
    """(n, 4, 2) m, counter-clockwise: the inside of an odd number of closed outlines.

    The plane is cut into slabs between all corners and crossings; within a slab no edges cross, so
    every second gap between them is solid. Holes and crossing outlines need no special treatment.
    FormatError if they enclose nothing, or for more than MOST_POINTS.
    """
    loops = [np.array(list(outline), float) for outline in outlines]
    if sum(len(loop) for loop in loops) > MOST_POINTS:
        raise FormatError(f"<polyline>: more than {MOST_POINTS} points; leave some out")
    edges = np.concatenate([
        np.stack([loop, np.roll(loop, -1, axis=0)], axis=1) for loop in loops])
    edges = edges[edges[:, 0, 1] != edges[:, 1, 1]]
    found = []
    levels = _levels(edges)
    for low, high in itertools.pairwise(levels):
        middle = (low + high) / 2
        ends = edges[:, :, 1]
        crossing = edges[(ends.min(axis=1) < middle) & (ends.max(axis=1) > middle)]
        crossing = crossing[np.argsort(_x_at(crossing, middle))]
        at_low, at_high = _x_at(crossing, low), _x_at(crossing, high)
        for i in range(0, len(crossing) - 1, 2):
            found.append([(at_low[i], low), (at_low[i + 1], low),
                          (at_high[i + 1], high), (at_high[i], high)])
    if not found:
        raise FormatError("<polyline>: its points enclose nothing; give three or more <point>s")
    return np.array(found)


def dark_rectangles(dark: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Rectangles (left, top, right, bottom), px, that cover a (height, width) mask exactly.

    Runs of a row are merged with equal runs of the row above.
    """
    done: list[tuple[int, int, int, int]] = []
    growing: dict[tuple[int, int], int] = {}  # run -> row in which it began
    for row in range(len(dark) + 1):
        runs = _runs(dark[row]) if row < len(dark) else set()
        for run in [run for run in growing if run not in runs]:
            done.append((run[0], growing.pop(run), run[1], row))
        for run in runs:
            growing.setdefault(run, row)
    return done


def _levels(edges: np.ndarray) -> list[float]:
    """Every y at which an edge ends or two cross."""
    levels = set(edges[:, :, 1].ravel().tolist())
    starts, ways = edges[:, 0], edges[:, 1] - edges[:, 0]
    for start, way in zip(starts, ways, strict=True):
        gap = starts - start
        across = way[0] * ways[:, 1] - way[1] * ways[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            mine = (gap[:, 0] * ways[:, 1] - gap[:, 1] * ways[:, 0]) / across
            other = (gap[:, 0] * way[1] - gap[:, 1] * way[0]) / across
        meet = (mine > 0) & (mine < 1) & (other > 0) & (other < 1)
        levels.update((start[1] + mine[meet] * way[1]).tolist())
    return sorted(levels)


def _x_at(edges: np.ndarray, y: float) -> np.ndarray:
    start, end = edges[:, 0], edges[:, 1]
    return start[:, 0] + (y - start[:, 1]) / (end[:, 1] - start[:, 1]) * (end[:, 0] - start[:, 0])


def _runs(row: np.ndarray) -> set[tuple[int, int]]:
    change = np.flatnonzero(np.diff(np.concatenate([[0], row.astype(np.int8), [0]])))
    return set(zip(change[::2].tolist(), change[1::2].tolist(), strict=True))


def _prisms(bases: np.ndarray, height: float) -> MeshPart:
    """(n, 4, 2) m, counter-clockwise, from z = 0 to `height`."""
    count = len(bases)
    low = np.concatenate([bases, np.zeros((count, 4, 1))], axis=2)
    high = np.concatenate([bases, np.full((count, 4, 1), height)], axis=2)
    vertices = np.concatenate([low, high], axis=1).reshape(-1, 3)
    faces = (np.arange(count)[:, None, None] * 8 + PRISM_FACES).reshape(-1, 3)
    corners = vertices[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return _with_images(flat_shaded(vertices, faces[area > 0]))


def _with_images(part: MeshPart) -> MeshPart:
    """A texture covers 1 m: seen from above on horizontal faces, upright on walls."""
    x, y, z = part.vertices.T
    level = np.abs(part.normals[:, 2:]) > 0.5
    along = -part.normals[:, 1] * x + part.normals[:, 0] * y
    uv = np.where(level, np.stack([x, y], axis=1), np.stack([along, z], axis=1))
    return replace(part, uv=uv.astype(np.float32))


FINEST = 173  # corners along a side; larger images are sampled, see MOST_COLLIDING
BARE = TerrainLayer(Material(ambient=(0.45, 0.4, 0.3, 1.0), diffuse=(0.45, 0.4, 0.3, 1.0)))


def heightmap_parts(shape: Heightmap) -> tuple[MeshPart, ...]:
    """A part for each layer that is visible anywhere, in the link frame.

    FormatError as from `read_image`.
    """
    heights = _heights(shape)
    rows, columns = heights.shape
    across, along, _ = shape.size
    x, y = np.meshgrid(np.linspace(-across / 2, across / 2, columns),
                       np.linspace(along / 2, -along / 2, rows))
    vertices = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
    slope_y, slope_x = np.gradient(heights, -along / (rows - 1), across / (columns - 1))
    normals = np.stack([-slope_x, -slope_y, np.ones_like(heights)], axis=-1).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    # The image's rows go downwards, so each triangle's other side is above.
    faces = grid_faces(rows, columns).reshape(-1, 2, 3)[:, ::-1, (0, 2, 1)].reshape(-1, 3)
    layers = shape.layers or (BARE,)
    bounds = [layer.lowest for layer in layers[1:]]
    layer_of = np.searchsorted(bounds, heights.ravel()[faces].mean(axis=1), side="right")
    return tuple(
        MeshPart(
            vertices=(vertices + shape.position).astype(np.float32),
            normals=normals.astype(np.float32),
            uv=(vertices[:, :2] / layer.tile).astype(np.float32),
            faces=np.ascontiguousarray(faces[layer_of == number], np.uint32),
            material=layer.material,
        )
        for number, layer in enumerate(layers) if (layer_of == number).any()
    )


def _heights(shape: Heightmap) -> np.ndarray:
    """Heights (rows, columns), m above the black level, the image's upper row first."""
    if shape.path is None:
        return np.zeros((2, 2))
    with prefixed("heightmap"):
        image = read_image(shape.path, cv2.IMREAD_ANYDEPTH | cv2.IMREAD_GRAYSCALE,
                           "give a grey PNG")
    white = np.iinfo(image.dtype).max if image.dtype.kind == "u" else max(float(image.max()), 1e-9)
    size = [min(max(side, 2), FINEST) for side in image.shape]
    grey = image if size == list(image.shape) else _sampled(image, *size)
    return np.nan_to_num(grey.astype(np.float64) / white) * shape.size[2]


def _sampled(grey: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Fewer corners, with the same edges: a pixel is a corner of the ground, not a cell of it."""
    upper, lower, down = _between(grey.shape[0], rows)
    left, right, along = _between(grey.shape[1], columns)
    down = down[:, None]

    def row(index: np.ndarray) -> np.ndarray:
        return grey[np.ix_(index, left)] * (1 - along) + grey[np.ix_(index, right)] * along

    return row(upper) * (1 - down) + row(lower) * down


def _between(pixels: int, corners: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For each corner on a line, the pixels before and after it, and the weight of the latter."""
    place = np.linspace(0, pixels - 1, corners)
    before = place.astype(np.int64)
    return before, np.minimum(before + 1, pixels - 1), place - before


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

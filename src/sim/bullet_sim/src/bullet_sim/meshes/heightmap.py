"""Triangles of heightmaps: a grid of heights from a grey image, in layers with one look each."""

import cv2
import numpy as np

from bullet_sim.description import Heightmap, Material, TerrainLayer
from bullet_sim.errors import prefixed
from bullet_sim.meshes.images import read_image
from bullet_sim.meshes.part import MeshPart, grid_faces

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

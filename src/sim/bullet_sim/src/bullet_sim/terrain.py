"""Triangles of heightmaps: a grid of heights read from a grey image, in layers of one look each."""

from __future__ import annotations

import cv2
import numpy as np

from bullet_sim.description import Heightmap, Material, TerrainLayer
from bullet_sim.errors import FormatError
from bullet_sim.mesh_part import MeshPart

FINEST = 173  # corners along a side; larger images are taken coarser, see MOST_COLLIDING
BARE = TerrainLayer(Material(ambient=(0.45, 0.4, 0.3, 1.0), diffuse=(0.45, 0.4, 0.3, 1.0)))


def heightmap_parts(shape: Heightmap) -> tuple[MeshPart, ...]:
    """A part for each layer that shows anywhere, in the link frame."""
    heights = _heights(shape)
    rows, columns = heights.shape
    across, along, _ = shape.size
    x, y = np.meshgrid(np.linspace(-across / 2, across / 2, columns),
                       np.linspace(along / 2, -along / 2, rows))
    vertices = np.stack([x, y, heights], axis=-1).reshape(-1, 3)
    slope_y, slope_x = np.gradient(heights, -along / (rows - 1), across / (columns - 1))
    normals = np.stack([-slope_x, -slope_y, np.ones_like(heights)], axis=-1).reshape(-1, 3)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    faces = _grid(rows, columns)
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
    """(rows, columns) m above the black level, the image's upper row first."""
    if shape.path is None:
        return np.zeros((2, 2))
    image = cv2.imread(shape.path, cv2.IMREAD_ANYDEPTH | cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise FormatError(f"heightmap {shape.path} cannot be read; give a grey PNG")
    white = np.iinfo(image.dtype).max if image.dtype.kind == "u" else max(float(image.max()), 1e-9)
    grey = np.nan_to_num(image.astype(np.float64) / white)
    size = [min(max(side, 2), FINEST) for side in grey.shape]
    if size != list(grey.shape):
        grey = _sampled(grey, *size)
    return grey * shape.size[2]


def _sampled(grey: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """Fewer corners, at the same edges: a pixel is a corner of the ground, not a cell of it."""
    row = np.linspace(0, grey.shape[0] - 1, rows, dtype=np.float32)
    column = np.linspace(0, grey.shape[1] - 1, columns, dtype=np.float32)
    where_x, where_y = np.meshgrid(column, row)
    return cv2.remap(grey.astype(np.float32), where_x, where_y,
                     cv2.INTER_LINEAR).astype(np.float64)


def _grid(rows: int, columns: int) -> np.ndarray:
    """(n, 3) triangles, counter-clockwise seen from above."""
    row, column = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = row * columns + column  # upper left
    b, c, d = a + columns, a + columns + 1, a + 1
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)

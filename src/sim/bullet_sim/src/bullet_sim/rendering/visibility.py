"""Finds the parts of a scene that may be in the image, and the order in which to draw them.

Rectangles of an image are (2, 2): x y of two corners, -1..1 from side to side. If the first corner
is not below the second in both, it is empty.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bullet_sim.meshes.part import box_corners
from bullet_sim.rendering.scene import LinkShape, Node

NOWHERE = np.array([[1.0, 1.0], [-1.0, -1.0]])
TILE = 64  # px

# The methods of arrays go through Python first; few numbers take less time than that.
_all, _any = np.logical_and.reduce, np.logical_or.reduce

Scissor = tuple[int, int, int, int]  # px: left, first row, width, height


def is_empty(rectangles: np.ndarray) -> np.ndarray:
    """(...) bool of (..., 2, 2)."""
    return (rectangles[..., 0, :] >= rectangles[..., 1, :]).any(axis=-1)


def rectangles_of(corners: np.ndarray, clip_world: np.ndarray) -> np.ndarray:
    """(n, 2, 2): rectangles of the image with boxes of these corners (n, 8, 3), clipped to it.

    The bits of a corner's index tell on which of opposite sides it is; sixteen corners are the
    region over which a box sweeps. `clip_world` (4, 4) is world to clip coordinates of the image.
    """
    clip = corners @ clip_world[:, :3].T + clip_world[:, 3]
    ahead = clip[..., 2] + clip[..., 3]  # not below 0: not behind the near plane
    behind = (ahead < 0).any(axis=1)
    if not behind.any():
        return _around(clip)
    found = np.empty((len(clip), 2, 2))
    found[~behind] = _around(clip[~behind])
    found[behind] = _around_ahead(clip[behind], ahead[behind])
    return found


def _around(clip: np.ndarray) -> np.ndarray:
    """Of boxes whose corners (n, c, 4) are all in front of the near plane."""
    place = clip[..., :2] / clip[..., 3:]
    return np.stack([place.min(axis=1).clip(-1.0), place.max(axis=1).clip(max=1.0)], axis=1)


def _around_ahead(clip: np.ndarray, ahead: np.ndarray) -> np.ndarray:
    """Of the parts in front of the near plane, of boxes with corners (n, c, 4); `ahead` (n, c)."""
    edges = _edges(clip.shape[1])
    one, other = clip[:, edges[0]], clip[:, edges[1]]
    cut = (ahead[:, edges[0]] < 0) != (ahead[:, edges[1]] < 0)
    rise = np.where(cut, ahead[:, edges[0]] - ahead[:, edges[1]], 1.0)
    share = np.where(cut, ahead[:, edges[0]] / rise, 0.0)
    points = np.concatenate([clip, one + share[..., None] * (other - one)], axis=1)
    valid = np.concatenate([ahead >= 0, cut], axis=1)[..., None]
    place = points[..., :2] / np.where(valid, points[..., 3:], 1.0)
    low, high = np.where(valid, place, 1.0), np.where(valid, place, -1.0)
    return np.stack([np.maximum(low.min(axis=1), -1.0), np.minimum(high.max(axis=1), 1.0)], axis=1)


def tiles(places: np.ndarray, extent: np.ndarray, width: int,
          height: int) -> list[tuple[Scissor, bool]]:
    """The tiles that `extent` (2, 2) of an image touches, as rectangles of whole tiles, and whether
    one of the places (n, 2, 2) is in each.

    Tiles have the size of llvmpipe's, which it draws one by one.
    """
    size = np.array([width, height]) / (2 * TILE)
    every = np.concatenate([extent[None], places])
    low = np.floor((every[:, 0] + 1) * size).astype(int).tolist()
    high = np.ceil((every[:, 1] + 1) * size).astype(int).tolist()
    (first_column, first_row), (end_column, end_row) = low[0], high[0]
    rows = [0] * end_row  # bit c of a row: a place is in column c
    for (left, first), (right, last) in zip(low[1:], high[1:], strict=True):
        for row in range(first, min(last, end_row)):
            rows[row] |= (1 << right) - (1 << left)
    found = []
    for first, last, columns in _runs(rows[first_row:], first_row):
        inside = [bool(columns >> column & 1) for column in range(first_column, end_column)]
        found += [((left * TILE, first * TILE, min(right * TILE, width) - left * TILE,
                    min(last * TILE, height) - first * TILE), there)
                  for left, right, there in _runs(inside, first_column)]
    return found


def _runs(values: list[int], start: int) -> list[tuple[int, int, int]]:
    """Start, end and value of each run of equal values; the first index is `start`."""
    found = []
    for value, equal in itertools.groupby(values):
        end = start + len(list(equal))
        found.append((start, end, value))
        start = end
    return found


@functools.cache
def _edges(corners: int) -> np.ndarray:
    """(2, n): the numbers of the two corners of each edge of a box with `corners` corners."""
    bits = [1 << bit for bit in range(corners.bit_length() - 1)]
    return np.array([(one, one | bit) for bit in bits for one in range(corners)
                     if not one & bit]).T


@dataclass(frozen=True)
class Visibility:
    """For one image; row i of an array belongs to the scene's node i."""

    clip_node: np.ndarray  # (n, 4, 4), node frame to clip coordinates
    parts: list[list[bool]]  # for each node, whether each of its parts may be visible
    depths: list[list[float]]  # m, of each of these parts' nearest corner from the camera
    order: list[int]  # nodes, nearest first; of those around the camera, small first


class Outlines:
    """Boxes around the parts of all nodes, tested against a view in one go."""

    def __init__(self, shapes: Sequence[LinkShape]):
        boxes = [box_corners(part) for shape in shapes for part in shape.parts]
        self._corners = np.array(boxes).reshape(-1, 4, 8)
        counts = [len(shape.parts) for shape in shapes]
        self._owner = np.repeat(np.arange(len(shapes)), counts)
        ends = itertools.accumulate(counts)
        self._spans = [slice(end - count, end) for end, count in zip(ends, counts, strict=True)]
        self._centres = np.array([[*shape.centre, 1.0] for shape in shapes]).reshape(-1, 4, 1)
        self._radii = np.array([shape.radius for shape in shapes])

    def seen(self, nodes: Sequence[Node], clip_world: np.ndarray, eye: np.ndarray) -> Visibility:
        """`clip_world` (4, 4) is world to clip coordinates, `eye` (3,) the camera's position."""
        world_node = np.array([node.matrix for node in nodes]).reshape(-1, 4, 4)
        clip_node = clip_world @ world_node
        clip = clip_node[self._owner] @ self._corners
        axes, w = clip[:, :3], clip[:, 3:]
        # Outside if all corners are beyond the same side of the view.
        outside = _all(axes < -w, axis=2) | _all(axes > w, axis=2)
        parts = self._by_node(~_any(outside, axis=1))
        depths = self._by_node(np.minimum.reduce(clip[:, 3], axis=1))
        away = (world_node @ self._centres)[:, :3, 0] - eye
        gaps = np.maximum(0.0, np.sqrt(np.add.reduce(away * away, axis=1)) - self._radii)
        order = np.lexsort((self._radii, gaps)).tolist()
        return Visibility(clip_node, parts, depths,
                          [index for index in order if any(parts[index])])

    def boxes(self, nodes: Sequence[Node]) -> np.ndarray:
        """(n, 8, 3): corners in the world of boxes around every part of every node."""
        world_node = np.array([node.matrix for node in nodes]).reshape(-1, 4, 4)
        return (world_node[self._owner] @ self._corners)[:, :3].swapaxes(1, 2)

    def _by_node(self, of_parts: np.ndarray) -> list[list]:
        """Splits a value per part into a list for each node."""
        values = of_parts.tolist()
        return [values[span] for span in self._spans]

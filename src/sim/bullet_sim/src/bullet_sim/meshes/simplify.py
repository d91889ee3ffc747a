"""Reduces triangles: all corners in one cell of a grid become one corner.

Vertex clustering (Rossignac and Borrel, 1993): one pass over arrays, so a million triangles take
a fraction of a second; no corner moves farther than the diagonal of its cell.
"""

import math

import numpy as np

MARGIN = 0.95  # the next attempt aims slightly below the limit
COARSEST = 4  # cells along the longest side


def cluster(vertices: np.ndarray, faces: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """At most `limit` triangles if the shape allows it, as the corners kept and new faces.

    `vertices` (n, 3) m and `faces` (m, 3). Returns indices (k,) into `vertices`, and faces (j, 3)
    uint32 into those k corners, without triangles that have become lines or points.
    """
    cells = max(COARSEST, math.isqrt(limit // 2))
    low = vertices.min(axis=0)
    span = float((vertices.max(axis=0) - low).max()) or 1.0
    while True:
        kept, joined = _joined(vertices, faces, low, span / cells, cells + 1)
        if len(joined) <= limit or cells <= COARSEST:
            return kept, joined
        cells = max(COARSEST, int(cells * MARGIN * math.sqrt(limit / len(joined))))


def _joined(
    vertices: np.ndarray, faces: np.ndarray, low: np.ndarray, cell: float, count: int
) -> tuple[np.ndarray, np.ndarray]:
    place = np.minimum((vertices - low) / cell, count - 1).astype(np.int64)
    key = (place[:, 0] * count + place[:, 1]) * count + place[:, 2]
    _, kept, index = np.unique(key, return_index=True, return_inverse=True)
    joined = index.reshape(-1)[faces].astype(np.uint32)
    joined = joined[(joined != np.roll(joined, 1, axis=1)).all(axis=1)]
    # Many small triangles become the same large one; rotated alike, equal ones have equal rows.
    first = joined.argmin(axis=1)[:, None]
    turned = np.take_along_axis(joined, (first + np.arange(3)) % 3, axis=1).astype(np.int64)
    size = np.int64(len(kept))
    # Three indices in one number: at most (cells + 1)^3 corners, far below 2^21 each.
    _, unique = np.unique((turned[:, 0] * size + turned[:, 1]) * size + turned[:, 2],
                          return_index=True)
    return kept, joined[np.sort(unique)]

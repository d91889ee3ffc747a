"""Coarser versions of a part, for distances at which nobody can see the difference."""

import math
import threading
from dataclasses import dataclass, replace

import fast_simplification
import numpy as np

from bullet_sim.meshes.part import MeshPart, equal_rows, face_normals, welded
from bullet_sim.meshes.smoothing import meeting_edges

MARGIN = 0.95  # the next attempt aims slightly below the limit
COARSEST = 4  # cells along the longest side


def cluster(vertices: np.ndarray, faces: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """At most `limit` triangles if the shape allows it, as the corners kept and new faces.

    Vertex clustering (Rossignac and Borrel, 1993): all corners in one cell of a grid become one.
    One pass over arrays, so a million triangles take a fraction of a second; no corner moves
    farther than the diagonal of its cell.

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


FEWEST = 500  # triangles that are worth simplifying
FINEST, LEVELS = 1 / 512, 6  # of half the part's size, the first tolerance; each is twice the last
GAIN = 0.7  # maximum share of triangles of the level before
# A corner's squares add up over some six planes, so that a surface stays far closer than the root
# of their sum: balls, rings and capsules within 0.9 of a level's tolerance, with previous levels.
SLACK = 1.8
MOST_AT_CORNER = 500  # triangles
FOLDED, MOST_RINGS = math.cos(math.radians(150)), 8  # of two triangles' normals; rings around them
NEIGHBOURS = 8  # corners of the part from which a new corner gets its normal
SAME_WAY = math.cos(math.radians(40))  # minimum between a triangle's normal and those

# The "lossless" mode of fast_simplification collapses an edge while the sum of the squares of the
# distances to the planes that met there, in the mesh's unit, is below this.
_lock = threading.Lock()  # fast_simplification keeps its mesh in global variables
_SQUARE = 2.220446049250313e-16


@dataclass(frozen=True, eq=False)
class Level:
    """A part with fewer triangles."""

    part: MeshPart
    tolerance: float  # m, approximate distance of its surface from the part's own


def finest_tolerance(part: MeshPart) -> float:
    """Tolerance of the first level, m, if there is one."""
    low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
    return float(np.linalg.norm(high.astype(float) - low)) / 2 * FINEST


def levels(part: MeshPart, fewest: int = FEWEST) -> list[Level]:
    """Coarser and coarser levels without image coordinates, if it has at least `fewest` triangles.

    Triangles that are folded onto one another stay as they are, such as those of a sheet with two
    sides: their edges could go anywhere on it. A part with very many triangles at a corner, which
    would take minutes, has no levels.
    """
    first = finest_tolerance(part)
    if len(part.faces) < fewest or first == 0.0:
        return []
    kept, place = equal_rows(part.vertices)
    vertices, faces = part.vertices[kept].astype(float), place[part.faces]
    if np.bincount(faces.reshape(-1)).max() > MOST_AT_CORNER:
        return []
    folded = _folded(vertices, faces)
    fixed, loose, points = vertices[faces[folded]], faces[~folded], vertices
    if len(loose) < fewest:
        return []
    found: list[Level] = []
    shading = _Shading(part)
    for tolerance in (first * 2 ** level for level in range(LEVELS)):
        fewer, fewer_loose = simplified(points, loose, tolerance * SLACK)
        if 0 < len(fixed) + len(fewer_loose) <= GAIN * (len(fixed) + len(loose)):
            points, loose = fewer, fewer_loose
            found.append(Level(shading.of(np.concatenate([fixed, points[loose]])), tolerance))
        if len(loose) < fewest:
            break
    return found


def simplified(vertices: np.ndarray, faces: np.ndarray,
               tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Fewer vertices (k, 3) m and faces (j, 3), in planes within `tolerance`, m, of all that they
    replace; edges where a surface ends stay as they are."""
    unit = tolerance / np.sqrt(_SQUARE)  # m
    with _lock:
        points, left = fast_simplification.simplify(
            vertices / unit, faces.astype(np.int32), target_reduction=1.0, lossless=True,
            preserve_border=True)
    return points * unit, left


def _folded(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(m,) bool: triangles at folded edges, and at those that become so without them."""
    normals, folded = face_normals(vertices[faces]), np.zeros(len(faces), bool)
    for _ in range(MOST_RINGS):
        loose = np.flatnonzero(~folded)
        one, other = meeting_edges(faces[loose])
        back = np.sum(normals[loose[one // 3]] * normals[loose[other // 3]], axis=1) < FOLDED
        if not back.any():
            return folded
        sharp = np.zeros(len(vertices), bool)
        sharp[faces[loose].reshape(-1)[np.concatenate([one[back], other[back]])]] = True
        folded |= sharp[faces].any(axis=1)
    return np.ones(len(faces), bool)


class _Shading:
    """Gives coarser triangles the normals of the part that they replace."""

    def __init__(self, part: MeshPart):
        from scipy.spatial import cKDTree  # takes 0.2 s, and small meshes do not need it

        self._part = part
        self._near = cKDTree(part.vertices)

    def of(self, triangles: np.ndarray) -> MeshPart:
        """Corners (j, 3, 3). A normal is the mean of the nearest ones that face as its triangle."""
        corners = triangles.reshape(-1, 3)
        own = np.repeat(face_normals(triangles), 3, axis=0)
        # A list, even of one, gives an array for each corner.
        nearest = list(range(1, min(NEIGHBOURS, len(self._part.vertices)) + 1))
        away, near = self._near.query(corners, nearest)
        normals = self._part.normals[near]  # (3 j, at most NEIGHBOURS, 3)
        alike = (normals * own[:, None]).sum(axis=2) > SAME_WAY
        weights = alike / (away / (away.mean(axis=1, keepdims=True) + 1e-9) + 1e-3) ** 2
        mean = (normals * weights[..., None]).sum(axis=1)
        length = np.linalg.norm(mean, axis=1, keepdims=True)
        return welded(replace(
            self._part, uv=None, vertices=corners.astype(np.float32),
            normals=np.where(length > 0, mean / np.where(length > 0, length, 1), own).astype(
                np.float32),
            faces=np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)))

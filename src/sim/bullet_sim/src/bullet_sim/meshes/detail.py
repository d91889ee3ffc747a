"""Coarser versions of a part, for when it is so far away that nobody can tell the difference."""

import math
import threading
from dataclasses import dataclass, replace

import fast_simplification
import numpy as np

from bullet_sim.meshes.part import MeshPart, equal_rows, face_normals, welded
from bullet_sim.meshes.smoothing import meeting_edges

FEWEST = 500  # triangles that are worth it
FINEST, LEVELS = 1 / 512, 6  # of half the part's size, the first tolerance; each is twice the last
GAIN = 0.7  # of the triangles of the level before, at most
# A corner's squares add up over some six planes, so that a surface stays far closer than the root
# of their sum: balls, rings and capsules within 0.9 of a level's tolerance, levels before included.
SLACK = 1.8
MOST_AT_CORNER = 500  # triangles
FOLDED = math.cos(math.radians(150))  # between two triangles' normals
NEIGHBOURS = 8  # corners of the part whose normals a new one has
SAME_WAY = math.cos(math.radians(40))  # between a triangle's normal and those, at least

# fast_simplification's way "without loss" collapses an edge while the sum of the squares of the
# distances to the planes that met there, in the mesh's unit, is below this.
_lock = threading.Lock()  # fast_simplification keeps its mesh in global variables
_SQUARE = 2.220446049250313e-16


@dataclass(frozen=True, eq=False)
class Level:
    """A part in few triangles."""

    part: MeshPart
    tolerance: float  # m, that its surface is away from the part's own, about


def finest_tolerance(part: MeshPart) -> float:
    """m, of the first level, if there is one."""
    low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
    return float(np.linalg.norm(high.astype(float) - low)) / 2 * FINEST


def levels(part: MeshPart, fewest: int = FEWEST) -> list[Level]:
    """Coarser and coarser ones without image coordinates, of parts of at least `fewest` triangles.

    None of a surface that is folded on itself, such as a sheet with two sides: its edges could go
    anywhere on it. None of one with very many triangles at a corner, which would take minutes.
    """
    first = finest_tolerance(part)
    if len(part.faces) < fewest or first == 0.0:
        return []
    kept, place = equal_rows(part.vertices)
    vertices, faces = part.vertices[kept].astype(float), place[part.faces]
    if np.bincount(faces.reshape(-1)).max() > MOST_AT_CORNER or _is_folded(vertices, faces):
        return []
    found: list[Level] = []
    shading = _Shading(part)
    for tolerance in (first * 2 ** level for level in range(LEVELS)):
        fewer, fewer_faces = simplified(vertices, faces, tolerance * SLACK)
        if 0 < len(fewer_faces) <= GAIN * len(faces):
            vertices, faces = fewer, fewer_faces
            found.append(Level(shading.of(vertices, faces), tolerance))
        if len(faces) < fewest:
            break
    return found


def simplified(vertices: np.ndarray, faces: np.ndarray,
               tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Fewer vertices (k, 3) m and faces (j, 3), in planes within `tolerance`, m, of all that they
    stand for; edges where a surface ends stay as they are."""
    unit = tolerance / np.sqrt(_SQUARE)  # m
    with _lock:
        points, left = fast_simplification.simplify(
            vertices / unit, faces.astype(np.int32), target_reduction=1.0, lossless=True,
            preserve_border=True)
    return points * unit, left


def _is_folded(vertices: np.ndarray, faces: np.ndarray) -> bool:
    normals = face_normals(vertices[faces])
    one, other = (edges // 3 for edges in meeting_edges(faces))
    return bool((np.sum(normals[one] * normals[other], axis=1) < FOLDED).any())


class _Shading:
    """Gives coarser triangles the normals of the part that they stand for."""

    def __init__(self, part: MeshPart):
        from scipy.spatial import cKDTree  # takes a fifth of a second, and small meshes need none

        self._part = part
        self._near = cKDTree(part.vertices)

    def of(self, vertices: np.ndarray, faces: np.ndarray) -> MeshPart:
        """Each corner's normal is the mean of the nearest ones that point as the triangle does."""
        corners = vertices[faces].reshape(-1, 3)
        own = np.repeat(face_normals(vertices[faces]), 3, axis=0)
        away, near = self._near.query(corners, NEIGHBOURS)
        normals = self._part.normals[near]  # (3 j, NEIGHBOURS, 3)
        alike = (normals * own[:, None]).sum(axis=2) > SAME_WAY
        weights = alike / (away / (away.mean(axis=1, keepdims=True) + 1e-9) + 1e-3) ** 2
        mean = (normals * weights[..., None]).sum(axis=1)
        length = np.linalg.norm(mean, axis=1, keepdims=True)
        return welded(replace(
            self._part, uv=None, vertices=corners.astype(np.float32),
            normals=np.where(length > 0, mean / np.where(length > 0, length, 1), own).astype(
                np.float32),
            faces=np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)))

"""Normals for triangles without any: smooth over curved surfaces, sharp at edges."""

import math

import numpy as np

from bullet_sim.description import Material
from bullet_sim.meshes.part import MeshPart, equal_rows, face_normals, shaded

CREASE = math.radians(30)  # between two triangles; a larger angle is a visible edge


def smooth_shaded(
    vertices: np.ndarray,
    faces: np.ndarray,
    uv: np.ndarray | None = None,
    material: Material | None = None,
) -> MeshPart:
    """A part whose triangles are shaded as one surface where they meet at less than `CREASE`.

    `vertices` (n, 3) m, `faces` (m, 3), `uv` (n, 2). A corner's normal is the mean of those around
    it, each weighted by its triangle's angle there, so that it does not depend on how a flat face
    is divided. Equal corners are shared.
    """
    corners = np.asarray(vertices, np.float64)[faces]
    normals = face_normals(corners)
    group = _groups(corners.astype(np.float32), normals)
    weighted = (normals[:, None] * _angles(corners)[..., None]).reshape(-1, 3)
    summed = np.stack([np.bincount(group, weighted[:, axis]) for axis in range(3)], axis=1)[group]
    smooth = np.where(summed.any(axis=1, keepdims=True), summed, np.repeat(normals, 3, axis=0))
    return shaded(corners.reshape(-1, 3), smooth,
                  np.arange(len(smooth), dtype=np.uint32).reshape(-1, 3),
                  None if uv is None else np.asarray(uv, np.float32)[faces].reshape(-1, 2),
                  material)


def meeting_edges(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of coinciding edges of triangles (m, 3), whose corners are given by vertex index; each
    edge by the index of the corner at which it starts."""
    start = place.reshape(-1).astype(np.int64)
    end = np.roll(place, -1, axis=1).reshape(-1).astype(np.int64)
    edge = np.minimum(start, end) * (start.max(initial=0) + 1) + np.maximum(start, end)
    order = np.argsort(edge, kind="stable")
    first, second = order[:-1], order[1:]
    together = (edge[first] == edge[second]) & (start[first] != end[first])
    return first[together], second[together]


def _groups(corners: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(3 m,) groups of corners (m, 3, 3): equal for corners of one vertex whose triangles are
    connected there by edges that are not creases."""
    place = equal_rows(corners.reshape(-1, 3))[1].reshape(-1, 3)
    first, second = meeting_edges(place)
    smooth = (normals[first // 3] * normals[second // 3]).sum(axis=1) > math.cos(CREASE)
    first, second = first[smooth], second[smooth]
    # Edge i goes from corner i to the next one of its triangle; the other triangle's edge goes
    # in the same direction or back.
    back = place.reshape(-1)[first] != place.reshape(-1)[second]
    links = np.concatenate([
        np.stack([first, np.where(back, _next(second), second)]),
        np.stack([_next(first), np.where(back, second, _next(second))])], axis=1)
    return _components(place.size, *links)


def _next(corner: np.ndarray) -> np.ndarray:
    """The next corner of the same triangle."""
    return corner - corner % 3 + (corner + 1) % 3


def _components(count: int, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(count,): the lowest number from which each can be reached by links between two."""
    least = np.arange(count)
    while True:
        mine, others = least[one], least[other]
        if np.array_equal(mine, others):
            return least
        lower = np.minimum(mine, others)
        np.minimum.at(least, mine, lower)
        np.minimum.at(least, others, lower)
        while not np.array_equal(least, further := least[least]):
            least = further


def _angles(corners: np.ndarray) -> np.ndarray:
    """Angles (m, 3), rad, of triangles (m, 3, 3) at each corner."""
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    across = np.linalg.norm(np.cross(ahead, behind), axis=2)
    return np.arctan2(across, (ahead * behind).sum(axis=2))

"""What the shadow map of a light covers, and which surfaces in a picture its shadows can fall on."""

from __future__ import annotations

import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.rendering.lights import light_direction

FINEST = 0.002  # m, of a texel
SIDES = (256, 512, 1024, 2048)  # texels, of a map
MARGIN = 2  # texels that stay free round what casts, so that nothing leaks from the next map
NOWHERE = np.array([[1.0, 1.0], [-1.0, -1.0]])
_ENDS = np.indices((2, 2)).reshape(2, 4)  # picks of the four edges of a beam
_CUBE = np.array([(corner, corner | bit) for bit in (1, 2, 4) for corner in range(8)
                  if not corner & bit]).T  # (2, 12): which of eight corners edges go between
_PARALLEL = 1e-9

Scissor = tuple[int, int, int, int]  # px: left, first row, width, height


class Beam:
    """The light that meets what casts: a box along the light, without an end."""

    def __init__(self, light: LightDescription, every: np.ndarray, fitted: np.ndarray):
        """Corners (4, n) in the world of all that casts, and of what the map is fitted to."""
        self._axes = _axes(light_direction(light))
        across, along = self._axes[:2] @ fitted[:3], self._axes[2] @ every[:3]
        self._low = np.array([*across.min(axis=1), along.min()])
        high = np.array([*across.max(axis=1), along.max()])
        self._span = np.maximum(high - self._low, FINEST)
        wanted = self._span[:2].max() / FINEST + 2 * MARGIN
        self.side = next((side for side in SIDES if side >= wanted), SIDES[-1])

    def matrix(self, side: int) -> np.ndarray:
        """(4, 4) from the world to clip coordinates of a map with so many texels a side."""
        fill = 1 - 2 * MARGIN / side
        scale = np.array([fill, fill, 1.0]) * 2 / self._span
        matrix = np.eye(4)
        matrix[:3, :3] = self._axes * scale[:, None]
        matrix[:3, 3] = -(self._low + self._span / 2) * scale
        return matrix

    def grain(self, side: int) -> float:
        """The size in m of a texel of such a map, along its longer side."""
        return float(self._span[:2].max()) / (side - 2 * MARGIN)

    def seen_on(self, low: np.ndarray, high: np.ndarray, clip_world: np.ndarray) -> np.ndarray:
        """(n, 2, 2): the rectangle of the picture, x y of two corners in -1..1, that it cannot leave.

        Of the shadow on what is in each of these boxes (n, 3) along the world's axes; the first
        corner is not below the second where there is none. `clip_world` (4, 4) is world to clip
        coordinates of the picture.
        """
        blur = MARGIN * self._span[:2] / (self.side - 2 * MARGIN)
        sides = np.array([self._low[:2] - blur, self._low[:2] + self._span[:2] + blur])
        middle, half = (low + high) / 2 @ self._axes.T, (high - low) / 2 @ np.abs(self._axes.T)
        met = ((middle - half)[:, :2] <= sides[1]).all(axis=1)
        met &= ((middle + half)[:, :2] >= sides[0]).all(axis=1)
        edges = np.array([sides[_ENDS[0], 0], sides[_ENDS[1], 1]]).T @ self._axes[:2]  # (4, 3)
        begin, end = self._slabs(low, high, edges)
        met &= begin.min(axis=2).max(axis=1) <= end.max(axis=2).min(axis=1)
        met &= end.max(axis=2).min(axis=1) >= self._low[2]
        thinnest = np.argmin((end - begin)[..., 0], axis=1)[:, None, None]
        ends = np.concatenate([np.take_along_axis(begin, thinnest, axis=1),
                               np.take_along_axis(end, thinnest, axis=1)], axis=1)  # (n, 2, 4)
        corners = edges + ends[..., None] * self._axes[2]
        rectangles = _rectangles(corners.reshape(len(low), 8, 3), clip_world)
        rectangles[~met] = NOWHERE
        return rectangles

    def _slabs(self, low: np.ndarray, high: np.ndarray,
               edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """From where to where along the light its edges are between opposite sides of boxes.

        Each (n, sides, 4): of a box, of its pairs of sides that are not along the light, of edges.
        """
        slanting = np.abs(self._axes[2]) > _PARALLEL
        both = np.stack([low, high])[:, :, slanting, None] - edges.T[slanting]
        both /= self._axes[2, slanting, None]
        return both.min(axis=0), both.max(axis=0)


def _axes(forward: np.ndarray) -> np.ndarray:
    """(3, 3) rows: two directions across, and along."""
    aside = np.eye(3)[np.argmin(np.abs(forward))]
    right = np.cross(forward, aside)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(right, forward), forward])


def _rectangles(corners: np.ndarray, clip_world: np.ndarray) -> np.ndarray:
    """(n, 2, 2): where in the picture boxes with these corners (n, 8, 3) are, cut to it."""
    clip = corners @ clip_world[:, :3].T + clip_world[:, 3]
    ahead = clip[..., 2] + clip[..., 3]  # not below 0: not behind the near plane
    one, other = clip[:, _CUBE[0]], clip[:, _CUBE[1]]
    cut = (ahead[:, _CUBE[0]] < 0) != (ahead[:, _CUBE[1]] < 0)
    rise = np.where(cut, ahead[:, _CUBE[0]] - ahead[:, _CUBE[1]], 1.0)
    share = np.where(cut, ahead[:, _CUBE[0]] / rise, 0.0)
    points = np.concatenate([clip, one + share[..., None] * (other - one)], axis=1)
    valid = np.concatenate([ahead >= 0, cut], axis=1)[..., None]
    place = points[..., :2] / np.where(valid, points[..., 3:], 1.0)
    low, high = np.where(valid, place, 1.0), np.where(valid, place, -1.0)
    return np.stack([np.maximum(low.min(axis=1), -1.0), np.minimum(high.max(axis=1), 1.0)], axis=1)


def inside_and_around(place: np.ndarray, width: int,
                      height: int) -> tuple[Scissor, list[Scissor]]:
    """A rectangle of `seen_on` in whole pixels, and what is left of the picture around it."""
    size = np.array([width, height])
    left, first = np.floor((place[0] + 1) / 2 * size).astype(int).tolist()
    right, last = np.ceil((place[1] + 1) / 2 * size).astype(int).tolist()
    around = [(0, 0, width, first), (0, last, width, height - last),
              (0, first, left, last - first), (right, first, width - right, last - first)]
    return (left, first, right - left, last - first), [one for one in around if min(one[2:]) > 0]

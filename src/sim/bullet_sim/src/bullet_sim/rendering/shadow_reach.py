"""What the shadow map of a light covers, and where in a picture its shadows can fall."""

from __future__ import annotations

import math

import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.rendering.lights import light_direction
from bullet_sim.rendering.rectangles import NOWHERE, rectangles_of

FINEST = 0.002  # m, of a texel
SIDES = (256, 512, 1024, 2048)  # texels, of a map
MARGIN = 2  # texels that stay free round what casts, so that nothing leaks from the next map
_ENDS = np.indices((2, 2)).reshape(2, 4)  # picks of the four edges of a beam
_PARALLEL = 1e-9
_NEAREST = 0.01  # m, from a spot light
_WIDEST = math.radians(160)  # of a spot light's map

Boxes = tuple[np.ndarray, np.ndarray]  # low and high corners (n, 3), along the world's axes


class Beam:
    """Of a directional light, what meets casters: a box along the light, without an end."""

    def __init__(self, light: LightDescription, every: np.ndarray, fitted: np.ndarray):
        """Corners (4, n) in the world of all that casts, and of what the map is fitted to."""
        self._axes = _axes(light_direction(light))
        across, along = self._axes[:2] @ fitted[:3], self._axes[2] @ every[:3]
        self._low = np.array([*across.min(axis=1), along.min()])
        high = np.array([*across.max(axis=1), along.max()])
        self._span = np.maximum(high - self._low, FINEST)
        self.side = _side(self._span[:2].max())

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

    def seen_on(self, boxes: Boxes, clip_world: np.ndarray) -> np.ndarray:
        """(n, 2, 2): rectangles of the picture that shadows on what is in the boxes cannot leave.

        `clip_world` (4, 4) is world to clip coordinates of the picture.
        """
        low, high = boxes
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
        rectangles = rectangles_of(corners.reshape(len(low), 8, 3), clip_world)
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


class Cone:
    """Of a spot light, all that it lights, in a pyramid."""

    def __init__(self, light: LightDescription, every: np.ndarray):
        """Corners (4, n) in the world of all that casts."""
        self._place = np.array(light.pose.position)
        self._axes = _axes(light_direction(light))
        self._half = min(light.outer_angle, _WIDEST) / 2
        self._range = light.range
        along = self._axes[2] @ (every[:3] - self._place[:, None])
        self._near = max(along.min(), _NEAREST)
        self._far = max(min(along.max(), light.range), self._near + _NEAREST)
        self.side = _side(2 * math.tan(self._half) * self._far)

    def matrix(self, side: int) -> np.ndarray:
        """(4, 4) from the world to clip coordinates; w is the depth along the light in m."""
        near, far = self._near, self._far
        scale = (1 - 2 * MARGIN / side) / math.tan(self._half)
        project = np.array([[scale, 0, 0, 0], [0, scale, 0, 0],
                            [0, 0, (far + near) / (far - near), -2 * far * near / (far - near)],
                            [0, 0, 1, 0]])
        turn = np.eye(4)
        turn[:3] = np.column_stack([self._axes, -self._axes @ self._place])
        return project @ turn

    def grain(self, side: int) -> float:
        """The size in m of a texel at a depth of 1 m, seen as aslant as at the cone's edge."""
        return 2 * math.tan(self._half) / math.cos(self._half) / (side - 2 * MARGIN)

    def seen_on(self, boxes: Boxes, clip_world: np.ndarray) -> np.ndarray:
        """As `Beam.seen_on`."""
        low, high = boxes
        reach = math.tan(self._half) * self._range
        ends = np.array([-1, 1])[_ENDS].T @ self._axes[:2] * reach + self._axes[2] * self._range
        corners = self._place + np.concatenate([np.zeros((4, 3)), ends])
        met = ((low <= corners.max(axis=0)) & (high >= corners.min(axis=0))).all(axis=1)
        rectangles = np.repeat(rectangles_of(corners[None], clip_world), len(low), axis=0)
        rectangles[~met] = NOWHERE
        return rectangles


def _side(extent: float) -> int:
    """Texels a side of a map of that many m."""
    wanted = extent / FINEST + 2 * MARGIN
    return next((side for side in SIDES if side >= wanted), SIDES[-1])


def _axes(forward: np.ndarray) -> np.ndarray:
    """(3, 3) rows: two directions across, and along."""
    aside = np.eye(3)[np.argmin(np.abs(forward))]
    right = np.cross(forward, aside)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(right, forward), forward])

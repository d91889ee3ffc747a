"""The region of a light's shadow map, and where its casters' shadows are in an image."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.rendering.lights import light_direction
from bullet_sim.rendering.rectangles import NOWHERE, rectangles_of

FINEST = 0.0015  # m, of a texel
SIDES = (256, 512, 1024, 2048)  # texels, of a map
MARGIN = 2  # texels kept free around casters, so that nothing leaks from the next map
_STEPS = 8  # of a map's side, by which it follows moving casters: within a step it need not change
_COARSER = 1.25  # from one size of texels to the next
_PARALLEL = 1e-6
_NEAREST = 0.01  # m, from a spot light
_WIDEST = math.radians(160)  # of a spot light's map
_SIGNS = np.indices((2, 2, 2)).reshape(3, 8) * 2.0 - 1  # of a box's corners, along its edges


@dataclass(frozen=True, eq=False)
class Reach:
    """The region of one light's map."""

    clip_world: np.ndarray  # (4, 4) from the world to clip coordinates of the map
    side: int  # texels
    grain: float  # m, of a texel; of a spot light at a depth of 1 m
    source: np.ndarray  # (4,) homogeneous, in the world: the light's position or direction
    # How far rays from the light are followed beyond casters, in distances between the two.
    follow: tuple[float, float]
    blur: float  # m, by which shadows may be wider than their casters


def reach_of(light: LightDescription, every: np.ndarray, fitted: np.ndarray) -> Reach:
    """Corners (n, 3) in the world of all casters, and of those that the map is fitted to."""
    return _cone(light, every) if light.type == "spot" else _beam(light, every, fitted)


def _beam(light: LightDescription, every: np.ndarray, fitted: np.ndarray) -> Reach:
    """For a directional light: a box along it. Its shadows have no end."""
    axes = _axes(light_direction(light))
    across, along = fitted @ axes[:2].T, every @ axes[2]
    span = np.ptp(across, axis=0).max() / (1 - 1 / _STEPS)
    side = _side(span)
    grain = FINEST * _COARSER ** max(0, _power(span / (side - 3 * MARGIN) / FINEST, _COARSER))
    step = grain * side / _STEPS
    low = np.floor(across.min(axis=0) / step) * step
    step = 2.0 ** _power(max(np.ptp(along), FINEST), 2.0)
    near, far = math.floor(along.min() / step) * step, math.ceil(along.max() / step + 1e-3) * step
    scale = 2 / np.array([grain * side, grain * side, far - near])
    middle = np.array([*(low + grain * (side / 2 - MARGIN)), (near + far) / 2])
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([axes * scale[:, None], -middle * scale])
    return Reach(matrix, side, grain, np.array([*-axes[2], 0.0]), (-math.inf, math.inf),
                 MARGIN * grain)


def _cone(light: LightDescription, every: np.ndarray) -> Reach:
    """For a spot light: a pyramid with all that it lights."""
    place = np.array(light.pose.position)
    axes = _axes(light_direction(light))
    slope = math.tan(min(light.outer_angle, _WIDEST) / 2)
    along = (every - place) @ axes[2]
    near = 2.0 ** (_power(max(along.min(), 2 * _NEAREST), 2.0) - 1)
    far = 2.0 ** _power(max(min(along.max(), light.range), 2 * near), 2.0)
    side = _side(2 * slope * far)
    scale = (1 - 2 * MARGIN / side) / slope
    project = np.array([[scale, 0, 0, 0], [0, scale, 0, 0],
                        [0, 0, (far + near) / (far - near), -2 * far * near / (far - near)],
                        [0, 0, 1, 0]])
    turn = np.eye(4)
    turn[:3] = np.column_stack([axes, -axes @ place])
    grain = 2 * slope * math.hypot(1, slope) / (side - 2 * MARGIN)
    return Reach(project @ turn, side, grain, np.array([*place, 1.0]),
                 (-0.9, light.range / near), MARGIN * grain * far)


def shadow_places(reach: Reach, casters: np.ndarray, in_map: np.ndarray, receivers: np.ndarray,
                  clip_world: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Indices of a caster (k,) and of a receiver (k,), and where the former's shadow may be on it.

    That is a rectangle (k, 2, 2) of the image. Casters and receivers are corners (n, 8, 3) in the
    world of boxes around them, `in_map` (n, 2, 2) the rectangles of the map with casters, and
    `clip_world` (4, 4) is world to clip coordinates of the image.
    """
    # A directional light is followed backwards, too: nothing is cut off before its map begins.
    lit = rectangles_of(receivers, np.diag([1, 1, reach.source[3], 1]) @ reach.clip_world)
    meet = (in_map[:, None, 0] <= lit[:, 1]) & (in_map[:, None, 1] >= lit[:, 0])
    one, other = np.nonzero(meet.all(axis=2))
    start = casters[one]
    ray = start * reach.source[3] - reach.source[:3]  # (k, 8, 3)
    # Start and end of corners' rays between two sides of the receiver's box, (k, 8, 3).
    slanting = ((ray > _PARALLEL).all(axis=1) | (ray < -_PARALLEL).all(axis=1))[:, None]
    sides = np.stack([receivers.min(axis=1), receivers.max(axis=1)])[:, other, None]
    both = (sides - start) / np.where(slanting, ray, 1.0)
    begin, end = both.min(axis=0), both.max(axis=0)
    first, last = reach.follow
    begin = np.where(slanting & (begin > first).all(axis=1, keepdims=True), begin, first)
    end = np.where(slanting & (end < last).all(axis=1, keepdims=True), end, last)
    until = end.max(axis=1).min(axis=1)
    met = (begin.min(axis=1).max(axis=1) <= until) & (until >= 0)
    thinnest = np.argmin((end - begin).max(axis=1), axis=1)[:, None, None]
    ends = [start + np.take_along_axis(along, thinnest, axis=2) * ray for along in (begin, end)]
    places = rectangles_of(np.concatenate(ends, axis=1), clip_world)
    places[~met] = NOWHERE
    depths = start @ reach.clip_world[3, :3] + reach.clip_world[3, 3]
    places[depths.min(axis=1) < _NEAREST] = -NOWHERE  # the spot light is in the caster's box
    return one, other, places


def widened(boxes: np.ndarray, by: float) -> np.ndarray:
    """Corners (n, 8, 3) of boxes enlarged by so many m on each side."""
    edges = boxes[:, [4, 2, 1]] - boxes[:, :1]
    return boxes + np.einsum("nij,ic->ncj", edges * by / np.linalg.norm(
        edges, axis=2, keepdims=True), _SIGNS)


def _side(extent: float) -> int:
    """The side, in texels, of a map of that many m."""
    wanted = extent / FINEST + 3 * MARGIN
    return next((side for side in SIDES if side >= wanted), SIDES[-1])


def _power(value: float, base: float) -> int:
    """The exponent of the least power of the base that is not less."""
    return math.ceil(math.log(value, base) - 1e-9) if value > 0 else 0


def _axes(forward: np.ndarray) -> np.ndarray:
    """(3, 3) rows: two directions across, and along."""
    aside = np.eye(3)[np.argmin(np.abs(forward))]
    right = np.cross(forward, aside)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(right, forward), forward])

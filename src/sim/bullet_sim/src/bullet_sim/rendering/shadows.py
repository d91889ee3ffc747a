"""Shadow maps: the depths seen from each light that casts shadows, side by side in one texture.

A map is as large as its casters need, not as the scene: nothing outside it is in shadow. Only
casters whose shadow may be in the image are drawn into it; when one moves, its part of the map is
drawn again. The edges of shadows are smoothed over two texels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.meshes.part import MeshPart, equal_rows
from bullet_sim.rendering.gl_calls import own_blocks
from bullet_sim.rendering.gpu_surfaces import SHADOWS_BINDING, SHADOWS_UNIT, Surface
from bullet_sim.rendering.lights import light_direction, warn_once
from bullet_sim.rendering.scene import Node, SceneState
from bullet_sim.rendering.shaders import MAX_LIGHTS, shader
from bullet_sim.rendering.visibility import NOWHERE, is_empty, rectangles_of

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
    """Corners (n, 8, 3) of boxes enlarged by `by` m on each side."""
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


MAX_SHADOWS = 4
_GROUND = 20.0  # m; a larger plane casts shadows, but maps are not enlarged for it
_ROUNDING = 16.0  # in `polygon_offset`'s units: error of a map's depths
_UNIT_CLIP = np.array([[0.5, 0, 0, 0.5], [0, 0.5, 0, 0.5], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])


def casting_lights(scene: SceneState) -> list[LightDescription]:
    """The lights that cast shadows, at most MAX_SHADOWS."""
    if not scene.description.shadows:
        return []
    casting = [light for light in list(scene.lights.values())[:MAX_LIGHTS] if _casts(light)]
    if len(casting) > MAX_SHADOWS:
        left_out = ", ".join(light.name for light in casting[MAX_SHADOWS:])
        warn_once(f"more than {MAX_SHADOWS} lights cast shadows; these do not: {left_out}")
    return casting[:MAX_SHADOWS]


def _casts(light: LightDescription) -> bool:
    """Whether it casts shadows; point lights do not, as in Gazebo."""
    return light.cast_shadows and (
        light.type == "directional" or (light.type == "spot" and light.outer_angle > 0))


@dataclass(eq=False)
class _Caster:
    """The surfaces of a node that cast shadows."""

    node: int  # its index in the scene
    boxes: np.ndarray  # (k, 4, 8) homogeneous corners of boxes around them, in the node's frame
    parts: list[int]  # index in the scene of the part to which each box belongs
    ground: bool  # a plane so large that maps are not made for it
    arrays: list[moderngl.VertexArray]


class ShadowPass:
    """Draws maps; one for all scenes."""

    def __init__(self, context: moderngl.Context):
        self.context = context
        self.program = context.program(vertex_shader=shader("shadow.vert"),
                                       fragment_shader=shader("shadow.frag"))
        self.map_model: moderngl.Uniform = self.program["map_model"]

    def of(self, scene: SceneState, surfaces: Sequence[Sequence[Surface]]) -> Shadows | None:
        """The shadows of a scene with these surfaces of its nodes; None if there are none."""
        lights = casting_lights(scene)
        casters, first = [], 0
        for number, (node, own) in enumerate(zip(scene.nodes.values(), surfaces, strict=True)):
            cast = [index for index, surface in enumerate(own) if surface.casts_shadows]
            if cast:
                boxes = [node.shape.parts[index].boxes for index in cast]
                parts = [first + index for index in cast for _ in node.shape.parts[index].boxes]
                arrays = [self._array(node.shape.parts[index]) for index in cast]
                ground = node.shape.plane_size > _GROUND
                casters.append(_Caster(number, np.concatenate(boxes), parts, ground, arrays))
            first += len(own)
        convex = np.array([surface.triangles.convex for own in surfaces for surface in own])
        return Shadows(self, lights, casters, convex) if lights and casters else None

    def _array(self, part: MeshPart) -> moderngl.VertexArray:
        """Its triangles, with each vertex position once, whatever the normals are."""
        kept, numbers = equal_rows(part.vertices)
        places = part.vertices[kept]
        return self.context.vertex_array(
            self.program, [(self.context.buffer(places), "3f", "in_position")],
            self.context.buffer(numbers[part.faces]))


class Shadows:
    """The maps of one version of a scene."""

    def __init__(self, drawing: ShadowPass, lights: list[LightDescription],
                 casters: list[_Caster], convex: np.ndarray):
        self.lights = lights
        self._pass = drawing
        self._casters = casters
        self._convex = convex  # (parts of the scene,), which cast no shadow on themselves
        self._parts = np.concatenate([caster.parts for caster in casters])
        self._owner = np.repeat(np.arange(len(casters)), [len(one.boxes) for one in casters])
        self._fitted = np.array([not caster.ground for caster in casters])[self._owner]
        self._block = drawing.context.buffer(reserve=80 * len(lights), dynamic=True)
        self._side = 0
        self._standing: list[Node] = []  # the casters' nodes as in the reaches
        self._reaches: list[Reach] = []
        self._wanted: list[Node | None] = []  # the casters' nodes that should be in the maps
        self._drawn: list[Node | None] = []  # and those that are
        self._areas: np.ndarray  # (lights, casters, 2, 2) px, of the maps, where they are

    def seen_on(self, nodes: Sequence[Node], boxes: np.ndarray, seen: np.ndarray,
                clip_world: np.ndarray) -> dict[int, tuple[np.ndarray, np.ndarray]]:
        """The rectangle (2, 2) of the image that a part is in, and those (k, 2, 2) that contain the
        shadows on it, by its index.

        Boxes (n, 8, 3) are around the scene's parts, and `seen` (n,) are in the image.
        """
        self._follow([nodes[caster.node] for caster in self._casters])
        parts = np.flatnonzero(seen)
        found = [shadow_places(reach, casters, in_map, boxes[parts], clip_world)
                 for reach, casters, in_map in zip(
                     self._reaches, self._wide, self._in_map, strict=True)]
        one, other, places = (np.concatenate(column) for column in zip(*found, strict=True))
        other = parts[other]
        there = ~is_empty(places) & ~((self._parts[one] == other) & self._convex[other])
        casting = np.isin(np.arange(len(self._casters)), self._owner[one[there]])
        # Casters for another camera's image stay: their shadows cannot be in this one.
        self._wanted = [node if casts or drawn is node else None for node, casts, drawn in
                        zip(self._standing, casting, self._drawn, strict=True)]
        shaded = np.unique(other[there])
        extents = rectangles_of(boxes[shaded], clip_world)
        return {part: (extent, places[there & (other == part)])
                for part, extent in zip(shaded.tolist(), extents, strict=True)}

    def use(self) -> None:
        """Let the surfaces drawn next have these shadows, as of the last `seen_on`."""
        changed = [new is not old for new, old in zip(self._wanted, self._drawn, strict=True)]
        if any(changed):
            self._draw(np.array(changed))
            self._pass.context.finish()  # llvmpipe takes far longer for both when they overlap
        self._texture.use(SHADOWS_UNIT)
        self._block.bind_to_uniform_block(SHADOWS_BINDING)

    def _follow(self, standing: list[Node]) -> None:
        if self._reaches and all(new is old for new, old in
                                 zip(standing, self._standing, strict=True)):
            return
        self._standing = standing
        boxes = np.concatenate([
            (node.matrix @ caster.boxes)[:, :3].swapaxes(1, 2)
            for node, caster in zip(standing, self._casters, strict=True)])
        fitted = boxes[self._fitted] if self._fitted.any() else boxes
        reaches = [reach_of(light, boxes.reshape(-1, 3), fitted.reshape(-1, 3))
                   for light in self.lights]
        self._wide = [widened(boxes, reach.blur) for reach in reaches]
        self._in_map = [rectangles_of(wide, reach.clip_world)
                        for wide, reach in zip(self._wide, reaches, strict=True)]
        if not self._reaches or any(not np.array_equal(new.clip_world, old.clip_world) for
                                    new, old in zip(reaches, self._reaches, strict=True)):
            self._reaches = reaches
            self._begin()

    def _begin(self) -> None:
        """Start with empty maps."""
        side = max(reach.side for reach in self._reaches)
        if side != self._side:
            self._side = side
            with own_blocks():
                self._texture = self._pass.context.depth_texture((side * len(self.lights), side))
            self._texture.compare_func = "<="
            self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._texture.repeat_x = self._texture.repeat_y = False
            self._framebuffer = self._pass.context.framebuffer(depth_attachment=self._texture)
        self._drawn = [None] * len(self._casters)
        self._areas = np.empty((len(self.lights), len(self._casters), 2, 2), int)
        self._areas[..., 0, :], self._areas[..., 1, :] = side, 0
        self._framebuffer.use()
        self._framebuffer.scissor = None
        self._framebuffer.clear()
        block = np.zeros((len(self._reaches), 5, 4), np.float32)
        for row, reach in zip(block, self._reaches, strict=True):
            row[:4] = (np.diag([reach.side / side, reach.side / side, 1, 1]) @ _UNIT_CLIP
                       @ reach.clip_world).T
            row[4, 0] = reach.grain
        self._block.write(block.tobytes())

    def _draw(self, changed: np.ndarray) -> None:
        """Draw again where changed casters were and are."""
        context, side = self._pass.context, self._side
        context.enable_only(moderngl.DEPTH_TEST)
        context.polygon_offset = (0.0, _ROUNDING)
        self._framebuffer.use()
        for number, reach in enumerate(self._reaches):
            areas = self._areas_of(number)
            both = np.concatenate([areas[changed], self._areas[number, changed]])
            low, high = both[:, 0].min(axis=0), both[:, 1].max(axis=0)
            self._areas[number] = areas
            if (low >= high).any():
                continue
            place = (number * side + int(low[0]), int(low[1]), *(high - low).tolist())
            self._framebuffer.viewport = (number * side, 0, reach.side, reach.side)
            self._framebuffer.scissor = place
            self._framebuffer.clear(viewport=place)
            meets = ((areas[:, 0] < high) & (areas[:, 1] > low)).all(axis=1)
            for index in np.flatnonzero(meets).tolist():
                clip_node = reach.clip_world @ self._standing[index].matrix
                self._pass.map_model.write(clip_node.T.astype(np.float32).tobytes())
                for array in self._casters[index].arrays:
                    array.render()
        self._drawn = self._wanted

    def _areas_of(self, number: int) -> np.ndarray:
        """(casters, 2, 2) px: the part of a light's map where each is drawn; empty if it is not."""
        places = (self._in_map[number] + 1) / 2 * self._reaches[number].side
        areas = np.empty((len(self._casters), 2, 2), int)
        areas[:, 0], areas[:, 1] = self._side, 0
        np.minimum.at(areas[:, 0], self._owner, np.floor(places[:, 0]).astype(int))
        np.maximum.at(areas[:, 1], self._owner, np.ceil(places[:, 1]).astype(int))
        unwanted = np.array([node is None for node in self._wanted])
        areas[unwanted] = [[self._side, self._side], [0, 0]]
        return areas

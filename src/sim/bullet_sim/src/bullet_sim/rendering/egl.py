"""The usual renderer: OpenGL without a screen, on a graphics card or llvmpipe.

Optimised for llvmpipe, OpenGL in software: one pass for colour and depth, one clear, triangles
uploaded once, back faces and links outside the image culled, meshes with fewer triangles where
half a pixel makes no difference (meshes/detail), near objects first, lighting per corner where
that is enough; no MSAA, no anisotropic filtering, which a graphics card has (`target`). Shadows are
a separate pass, only where something casts them (`shadows`). Back faces are not drawn, so that a
camera inside its own housing sees out.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import moderngl
import numpy as np

from bullet_sim.profiler import Profiler
from bullet_sim.rendering import gl_calls, lights
from bullet_sim.rendering.frame import (
    LARGEST_PX,
    CameraView,
    Frame,
    metres_from_depth,
    projection_matrix,
    view_matrix,
)
from bullet_sim.rendering.gpu_surfaces import (
    IMAGE_UNIT,
    LIGHTS_BINDING,
    SURFACE_BINDING,
    Drawing,
    Kind,
    Surface,
    SurfaceStore,
    Triangles,
)
from bullet_sim.rendering.scene import Node, SceneState
from bullet_sim.rendering.shadows import ShadowPass, Shadows
from bullet_sim.rendering.sky import Sky
from bullet_sim.rendering.target import Quality, Target, quality_of
from bullet_sim.rendering.visibility import Outlines, Scissor, Visibility, tiles

# OpenGL has the bottom row first. Drawing upside down puts the top row first and flips the winding.
_UPSIDE_DOWN = np.diag([1.0, -1.0, 1.0, 1.0])
# A highlight of less than half a grey level is not worth computing per pixel.
_VISIBLE = 0.5 / 255
_UNSEEN = 0.5  # px of allowed deviation from the mesh; half of it if depth is wanted
_MOST_DEVICES = 8
_VERSIONS_KEPT = 2  # of scenes: the one being drawn, and the one before
# In `polygon_offset`'s units. llvmpipe's depth of one plane is off by up to 6/2**24 (measured), and
# a unit is 2/2**24 there: enough to separate two planes, and 0.6 mm at 3 m for `near` 0.02.
# On a card, the snapping of vertices is added (`target`).
_RECESS = 10.0


@dataclass(eq=False)
class _Item:
    number: int  # of the part in the scene
    surface: Surface
    plain: Drawing
    shaded: Drawing | None  # where shadows fall
    triangles: Triangles
    kinds: tuple[Kind, Kind | None]  # of the two drawings
    coarser: dict[int, _Item]  # by the index among the coarser triangles


_Piece = tuple[_Item, Drawing, Scissor | None]  # what is drawn, how, in which part of the image


@dataclass(eq=False)
class _Prepared:
    """The lights and draw list of one version of a scene."""

    lights: moderngl.Buffer
    items: list[list[_Item]]  # of each node's parts, in the nodes' order
    outlines: Outlines
    ranks: dict[float, int]  # by size of plane: larger ones are drawn farther back
    shadows: Shadows | None
    kinds: set[Kind]


class EglRenderer:
    """See `renderer.Renderer`."""

    def __init__(self, profiler: Profiler | None = None,
                 quality: Callable[[moderngl.Context], Quality] = quality_of) -> None:
        """`quality`: settings of images; by default those suited to the device."""
        self._profiler = profiler or Profiler()
        self._context = _open_context()
        with self._context:  # leaving it releases the context, so that any thread may draw
            self._context.gc_mode = "context_gc"
            info = self._context.info
            self.name = f"EGL, {info['GL_RENDERER']}"
            self.largest_px = min(LARGEST_PX, info["GL_MAX_RENDERBUFFER_SIZE"],
                                  *info["GL_MAX_VIEWPORT_DIMS"])
            self._quality = quality(self._context)
            self._store = SurfaceStore(self._context, self._quality.anisotropy)
            self._sky = Sky(self._context)
            self._shadow_pass = ShadowPass(self._context)
            self._smallest = Target(self._context, (1, 1))
        self._prepared: dict[int, _Prepared] = {}  # by version, the latest last
        self._targets: dict[tuple[int, int, int], Target] = {}

    def draw(self, scene: SceneState, view: CameraView, depth: bool = False) -> Frame:
        """RGB, and depth if wanted, in one pass."""
        measure = self._profiler.measure
        with self._context:
            target = self._target(view.width, view.height, depth)
            with measure("submit"):
                self._store.show(scene.images)
                prepared = self._prepare(scene)
                self._submit(scene, prepared, view, target, _UNSEEN / 2 if depth else _UNSEEN)
                target.end(depth)
            with measure("draw"):  # what OpenGL alone takes
                gl_calls.finish()
            with measure("read back"):
                rgba, raw = target.read(depth)
        with measure("convert"):
            # llvmpipe stores RGBA; OpenCV drops the alpha faster than OpenGL would.
            rgb = cv2.cvtColor(rgba, cv2.COLOR_RGBA2RGB)
            metres = None if raw is None else metres_from_depth(raw, view.near, view.far)
        return Frame(rgb, metres)

    def trim(self) -> None:
        self._prepared.clear()
        self._targets.clear()
        with self._context:
            # Drivers keep the last framebuffer, even if deleted, until another is drawn in.
            self._smallest.start((0.0, 0.0, 0.0))
            gl_calls.finish()
            self._context.gc()

    def close(self) -> None:
        self._prepared.clear()
        self._targets.clear()
        with self._context:
            self._context.gc()
        self._context.release()

    def _target(self, width: int, height: int, depth: bool) -> Target:
        samples = self._quality.samples_of((width, height), depth)
        key = (width, height, samples)
        if key not in self._targets:
            self._targets[key] = Target(self._context, (width, height), samples,
                                        self._quality.pixel_buffers)
        return self._targets[key]

    def _prepare(self, scene: SceneState) -> _Prepared:
        prepared = self._prepared.pop(scene.version, None) or self._build(scene)
        self._prepared[scene.version] = prepared
        if len(self._prepared) > _VERSIONS_KEPT:
            del self._prepared[next(iter(self._prepared))]
            self._context.gc()  # memory of removed models
            self._store.keep({kind for one in self._prepared.values() for kind in one.kinds})
        return prepared

    def _build(self, scene: SceneState) -> _Prepared:
        near_lights = lights.needs_pixels(scene)
        shine = lights.strongest_highlight(scene)
        fog = None if scene.description.fog.type == "none" else scene.description.fog
        surfaces = [self._store.of(node.shape) for node in scene.nodes.values()]
        shadows = self._shadow_pass.of(scene, surfaces)
        casting = shadows.lights if shadows else []

        numbers = itertools.count()
        kinds = lights.kinds(scene, casting)

        def item(surface: Surface, number: int) -> _Item:
            per_pixel = near_lights or surface.highlight * shine > _VISIBLE
            bright = surface.highlight * shine > 0
            plain = Kind(per_pixel, kinds, bright, fog)
            shaded = Kind(per_pixel, kinds, bright, fog, len(casting))
            return self._item(number, surface, surface.triangles, plain,
                              shaded if casting else None)

        outlines = Outlines([node.shape for node in scene.nodes.values()])
        block = self._context.buffer(lights.lights_block(scene), dynamic=True)
        items = [[item(surface, next(numbers)) for surface in own] for own in surfaces]
        used = {kind for own in items for one in own for kind in one.kinds if kind}
        return _Prepared(block, items, outlines, scene.plane_ranks(), shadows, used)

    def _item(self, number: int, surface: Surface, triangles: Triangles, plain: Kind,
              shaded: Kind | None) -> _Item:
        return _Item(number, surface, self._store.drawing(triangles, plain),
                     shaded and self._store.drawing(triangles, shaded),
                     triangles, (plain, shaded), {})

    def _within(self, item: _Item, tolerance: float) -> _Item:
        """The coarsest item whose deviation is at most `tolerance`, m."""
        if tolerance < item.triangles.finest:
            return item
        fitting = [triangles for away, triangles in self._store.coarser(item.triangles)
                   if away <= tolerance]
        if not fitting:
            return item
        place = len(fitting) - 1
        if place not in item.coarser:
            item.coarser[place] = self._item(item.number, item.surface, fitting[-1], *item.kinds)
        return item.coarser[place]

    def _submit(self, scene: SceneState, prepared: _Prepared, view: CameraView,
                target: Target, unseen: float) -> None:
        """`unseen`: px of allowed deviation from the mesh."""
        clip_world = _UPSIDE_DOWN @ projection_matrix(view) @ view_matrix(view.pose)
        eye = np.array([*view.pose.position, 1.0], np.float32)
        prepared.lights.write(eye.tobytes(), offset=lights.EYE_OFFSET)
        prepared.lights.bind_to_uniform_block(LIGHTS_BINDING)
        nodes, focal = list(scene.nodes.values()), view.focal_length_px
        seen = prepared.outlines.seen(nodes, clip_world, eye[:3])
        places = _shadow_places(prepared, nodes, seen, clip_world)
        target.start(scene.description.background)
        see_through = []
        for index in seen.order:
            node, clip_node = nodes[index], seen.clip_node[index]
            opaque, others = [], []
            for item, visible, depth in zip(prepared.items[index], seen.parts[index],
                                            seen.depths[index], strict=True):
                if visible:
                    (opaque if item.surface.opaque else others).extend(_pieces(
                        self._within(item, unseen * depth / focal),
                        places.get(item.number), view))
            rank = prepared.ranks.get(node.shape.plane_size, 0)
            self._context.polygon_offset = rank * self._quality.snap_px, rank * _RECESS
            _render(target, node, opaque, clip_node)
            if others:
                see_through.append((node, others, clip_node))
        if scene.description.sky:
            self._context.polygon_offset = (0.0, 0.0)
            self._sky.draw(view)
        if see_through:
            target.blend()
            self._context.polygon_offset = (0.0, 0.0)
            for what in reversed(see_through):
                _render(target, *what)


def _render(target: Target, node: Node, pieces: list[_Piece], clip_node: np.ndarray) -> None:
    """Draw surfaces of one node."""
    if not pieces:
        return
    model = node.matrix.astype(np.float32).tobytes("F")  # OpenGL's matrices: column by column
    projection_model = clip_node.astype(np.float32).tobytes("F")
    for item, (program, array), scissor in pieces:
        program.model.write(model)
        program.projection_model.write(projection_model)
        item.surface.material.bind_to_uniform_block(SURFACE_BINDING)
        if item.surface.texture is not None:
            item.surface.texture.use(IMAGE_UNIT)
        if scissor is not None:
            target.framebuffer.scissor = scissor
        array.render()
        if scissor is not None:
            target.framebuffer.scissor = None


def _open_context() -> moderngl.Context:
    """A context on the first EGL device that works: llvmpipe comes after cards that fail."""
    refusals = []
    for index in range(_MOST_DEVICES):
        try:
            return moderngl.create_context(
                standalone=True, backend="egl", require=330, device_index=index
            )
        except Exception as error:  # glcontext raises bare exceptions
            refusals.append(error)
    raise refusals[0]


def _shadow_places(prepared: _Prepared, nodes: list[Node], seen: Visibility,
                   clip_world: np.ndarray) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """As `Shadows.seen_on`. Also makes the shadows ready to be drawn."""
    if prepared.shadows is None:
        return {}
    places = prepared.shadows.seen_on(nodes, prepared.outlines.boxes(nodes),
                                      np.fromiter(itertools.chain(*seen.parts), bool), clip_world)
    if places:
        prepared.shadows.use()
    return places


def _pieces(item: _Item, shadows: tuple[np.ndarray, np.ndarray] | None,
            view: CameraView) -> list[_Piece]:
    """How to draw a surface; `shadows` is its value in `Shadows.seen_on`."""
    if item.shaded is None or shadows is None:
        return [(item, item.plain, None)]
    if not item.surface.triangles.convex:
        return [(item, item.shaded, None)]
    extent, places = shadows
    return [(item, item.shaded if shaded else item.plain, place)
            for place, shaded in tiles(places, extent, view.width, view.height)]

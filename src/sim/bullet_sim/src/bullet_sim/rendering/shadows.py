"""Shadows: how far each light that casts them sees, drawn into maps side by side in one texture.

A map is as large as what casts needs, not as the scene: what is outside it lies in no shadow. It is
drawn again when something that casts has moved, and only if a shadow can be in the picture. The
edges of shadows are smoothed over two texels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np

from bullet_sim.description import LightDescription
from bullet_sim.rendering.gpu_surfaces import SHADOWS_BINDING, SHADOWS_UNIT, Surface
from bullet_sim.rendering.lights import warn_once
from bullet_sim.rendering.own_memory import own_blocks
from bullet_sim.rendering.rectangles import NOWHERE, is_empty
from bullet_sim.rendering.scene import Node, SceneState
from bullet_sim.rendering.shaders import MAX_LIGHTS, shader
from bullet_sim.rendering.shadow_reach import Beam, Boxes, Cone
from bullet_sim.rendering.visibility import box_corners

MAX_SHADOWS = 4
_GROUND = 20.0  # m; a wider plane shades what is in a map, which is not widened for it
_ROUNDING = 16.0  # in `polygon_offset`'s units, that a map's depths are off by
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
    """Lights that shine all round cast none, as in Gazebo."""
    return light.cast_shadows and (
        light.type == "directional" or (light.type == "spot" and light.outer_angle > 0))


@dataclass(eq=False)
class _Caster:
    """The surfaces of a node that cast shadows."""

    node: int  # its number in the scene
    corners: np.ndarray  # (4, n) homogeneous, of boxes around them, in the node's frame
    ground: bool  # a plane so wide that maps are not made for it
    arrays: list[moderngl.VertexArray]


class ShadowPass:
    """What draws maps; one for all scenes."""

    def __init__(self, context: moderngl.Context):
        self.context = context
        self.program = context.program(vertex_shader=shader("shadow.vert"),
                                       fragment_shader=shader("shadow.frag"))
        self.map_model: moderngl.Uniform = self.program["map_model"]

    def of(self, scene: SceneState, surfaces: Sequence[Sequence[Surface]]) -> Shadows | None:
        """The shadows of a scene with these surfaces of its nodes; None if there are none."""
        lights = casting_lights(scene)
        casters = []
        for number, (node, own) in enumerate(zip(scene.nodes.values(), surfaces, strict=True)):
            cast = [index for index, surface in enumerate(own) if surface.casts_shadows]
            if cast:
                boxes = [box_corners(node.shape.parts[index]) for index in cast]
                arrays = [self._array(own[index]) for index in cast]
                ground = node.shape.plane_size > _GROUND
                casters.append(_Caster(number, np.hstack(boxes), ground, arrays))
        return Shadows(self, lights, casters) if lights and casters else None

    def _array(self, surface: Surface) -> moderngl.VertexArray:
        return self.context.vertex_array(
            self.program, [(surface.vertices, "3f 5x4", "in_position")], surface.indices)


class Shadows:
    """The maps of one version of a scene."""

    def __init__(self, drawing: ShadowPass, lights: list[LightDescription],
                 casters: list[_Caster]):
        self.lights = lights
        self._pass = drawing
        self._casters = casters
        self._block = drawing.context.buffer(reserve=80 * len(lights), dynamic=True)
        self._side = 0
        self._standing: list[Node] = []  # the casters' nodes as the beams have them
        self._beams: list[Beam | Cone] = []
        self._drawn = False

    def seen_on(self, nodes: Sequence[Node], boxes: Boxes,
                clip_world: np.ndarray) -> np.ndarray:
        """(n, 2, 2): rectangles of the picture that no shadow on what is in the boxes leaves."""
        self._follow([nodes[caster.node] for caster in self._casters])
        places = np.array([beam.seen_on(boxes, clip_world) for beam in self._beams])
        places[is_empty(places)] = NOWHERE
        return np.stack([places[:, :, 0].min(axis=0), places[:, :, 1].max(axis=0)], axis=1)

    def use(self) -> None:
        """Let surfaces that are drawn next have these shadows, as of the last `seen_on`."""
        if not self._drawn:
            self._draw()
            self._drawn = True
        self._texture.use(SHADOWS_UNIT)
        self._block.bind_to_uniform_block(SHADOWS_BINDING)

    def _follow(self, standing: list[Node]) -> None:
        if self._beams and all(new is old for new, old in
                               zip(standing, self._standing, strict=True)):
            return
        corners = [node.matrix @ caster.corners
                   for node, caster in zip(standing, self._casters, strict=True)]
        fitted = [box for box, caster in zip(corners, self._casters, strict=True)
                  if not caster.ground]
        every = np.hstack(corners)
        near = np.hstack(fitted) if fitted else every
        self._beams = [Cone(light, every) if light.type == "spot" else Beam(light, every, near)
                       for light in self.lights]
        self._standing, self._drawn = standing, False

    def _draw(self) -> None:
        self._resize(max(beam.side for beam in self._beams))
        context, side = self._pass.context, self._side
        context.enable_only(moderngl.DEPTH_TEST)
        context.polygon_offset = (0.0, _ROUNDING)
        self._framebuffer.use()
        self._framebuffer.clear()
        matrices = [beam.matrix(side) for beam in self._beams]
        for number, clip_world in enumerate(matrices):
            self._framebuffer.viewport = (number * side, 0, side, side)
            for node, caster in zip(self._standing, self._casters, strict=True):
                clip_node = clip_world @ node.matrix
                self._pass.map_model.write(clip_node.T.astype(np.float32).tobytes())
                for array in caster.arrays:
                    array.render()
        block = np.zeros((len(matrices), 5, 4), np.float32)
        block[:, :4] = [(_UNIT_CLIP @ matrix).T for matrix in matrices]
        block[:, 4, 0] = [beam.grain(side) for beam in self._beams]
        self._block.write(block.tobytes())

    def _resize(self, side: int) -> None:
        if side == self._side:
            return
        self._side = side
        with own_blocks():
            self._texture = self._pass.context.depth_texture((side * len(self.lights), side))
        self._texture.compare_func = "<="
        self._texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self._texture.repeat_x = self._texture.repeat_y = False
        self._framebuffer = self._pass.context.framebuffer(depth_attachment=self._texture)

"""The sky of a scene that has one: a gradient behind everything, by a pixel's elevation."""

import moderngl

from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.shaders import shader

# Our own colours of a clear day; Gazebo's sky with clouds and a sun is not drawn.
HORIZON = (0.80, 0.86, 0.92)
ZENITH = (0.30, 0.50, 0.80)


class Sky:
    """Draws where the current framebuffer is still empty. Rows are top first."""

    def __init__(self, context: moderngl.Context):
        self._context = context
        self._program = context.program(
            vertex_shader=shader("sky.vert"), fragment_shader=shader("sky.frag"))
        self._program["horizon"], self._program["zenith"] = HORIZON, ZENITH
        self._array = context.vertex_array(self._program, [])

    def draw(self, view: CameraView) -> None:
        """Draw it, after opaque surfaces and before others."""
        axes = view.pose.matrix()[:3, :3]
        focal_px = view.focal_length_px
        self._program["forward"] = tuple(axes[:, 0])
        self._program["right"] = tuple(-axes[:, 1] * view.width / 2 / focal_px)
        self._program["down"] = tuple(-axes[:, 2] * view.height / 2 / focal_px)
        self._context.depth_func = "<="
        self._context.disable(moderngl.CULL_FACE)
        self._array.render(moderngl.TRIANGLES, vertices=3)
        self._context.enable(moderngl.CULL_FACE)
        self._context.depth_func = "<"

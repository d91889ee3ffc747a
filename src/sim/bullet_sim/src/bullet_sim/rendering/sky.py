"""The sky of a scene that has one: a gradient behind everything, by how high a pixel looks."""

import moderngl

from bullet_sim.rendering.frame import CameraView

# Our own colours of a clear day; Gazebo's sky with clouds and a sun is not drawn.
HORIZON = (0.80, 0.86, 0.92)
ZENITH = (0.30, 0.50, 0.80)

_VERTEX = """
#version 330
uniform vec3 forward;  // world, of length 1
uniform vec3 right;    // world, as long as half the picture is wide at depth 1
uniform vec3 down;
out vec3 ray;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    ray = forward + corner.x * right + corner.y * down;
    gl_Position = vec4(corner, 1.0, 1.0);  // as far away as can be: only where nothing is
}
"""
_FRAGMENT = """
#version 330
uniform vec3 horizon;
uniform vec3 zenith;
in vec3 ray;
out vec4 colour;
void main() {
    colour = vec4(mix(horizon, zenith, sqrt(max(normalize(ray).z, 0.0))), 1.0);
}
"""


class Sky:
    """Draws into what the present framebuffer has left free. Rows are first row first."""

    def __init__(self, context: moderngl.Context):
        self._context = context
        self._program = context.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
        self._program["horizon"], self._program["zenith"] = HORIZON, ZENITH
        self._array = context.vertex_array(self._program, [])

    def draw(self, view: CameraView) -> None:
        """After what is opaque, before what is not."""
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

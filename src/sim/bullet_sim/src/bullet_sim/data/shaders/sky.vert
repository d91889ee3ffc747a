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

#version 330
uniform mat4 map_model;
in vec3 in_position;
void main() {
    gl_Position = map_model * vec4(in_position, 1.0);
}

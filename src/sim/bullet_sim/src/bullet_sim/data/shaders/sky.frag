#version 330
uniform vec3 horizon;
uniform vec3 zenith;
in vec3 ray;
out vec4 colour;
void main() {
    colour = vec4(mix(horizon, zenith, sqrt(max(normalize(ray).z, 0.0))), 1.0);
}

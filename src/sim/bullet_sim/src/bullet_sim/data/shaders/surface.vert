uniform mat4 projection_model;
uniform mat4 model;
in vec3 in_position;
in vec3 in_normal;
in vec2 in_uv;
#ifdef PER_PIXEL
out vec3 position;
out vec3 normal;
#else
#ifdef SHADOWS
out vec3 corner_light;
out vec3 may_arrive[SHADOWS];
out vec3 map_place[SHADOWS];
#else
out vec3 light;
#endif
#endif
#ifdef TEXTURED
out vec2 uv;
#endif
void main() {
    gl_Position = projection_model * vec4(in_position, 1.0);
    vec3 world = (model * vec4(in_position, 1.0)).xyz;
    vec3 turned = mat3(model) * in_normal;
#ifdef PER_PIXEL
    position = world;
    normal = turned;
#else
#ifdef SHADOWS
    vec3 upright = normalize(turned);
    corner_light = lit(world, upright);
    for (int i = 0; i < SHADOWS; ++i) {
        may_arrive[i] = interceptable[i];
        map_place[i] = in_map(i, world, upright).xyz;
    }
#else
    light = lit(world, normalize(turned));
#endif
#endif
#ifdef TEXTURED
    uv = in_uv * texture_map.xy + texture_map.zw;
#endif
}

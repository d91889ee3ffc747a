#ifdef PER_PIXEL
in vec3 position;
in vec3 normal;
#else
#ifdef SHADOWS
in vec3 corner_light;
in vec3 may_arrive[SHADOWS];
in vec3 map_place[SHADOWS];
#else
in vec3 light;
#endif
#endif
#ifdef TEXTURED
in vec2 uv;
uniform sampler2D image;
#endif
#ifdef FOG
uniform vec3 fog_colour;
uniform int fog_kind;
uniform vec3 fog_shape;  // start, end, density
vec3 in_fog(vec3 colour) {
    float depth = 1.0 / gl_FragCoord.w;
    float thin = fog_shape.z * depth;
    float seen = fog_kind == LINEAR ? (fog_shape.y - depth) / max(fog_shape.y - fog_shape.x, 1e-6)
               : exp(fog_kind == EXP ? -thin : -thin * thin);
    return mix(fog_colour, colour, clamp(seen, 0.0, 1.0));
}
#endif
out vec4 colour;
void main() {
#ifdef PER_PIXEL
    vec3 light = lit(position, normalize(normal));
#elif defined(SHADOWS)
    vec3 light = corner_light;
    for (int i = 0; i < SHADOWS; ++i) light += may_arrive[i] * arriving(i, map_place[i]);
    light = min(light, 1.0);
#endif
#ifdef TEXTURED
    colour = vec4(light * texture(image, uv).rgb, diffuse.a);
#else
    colour = vec4(light, diffuse.a);
#endif
#ifdef FOG
    colour.rgb = in_fog(colour.rgb);
#endif
}

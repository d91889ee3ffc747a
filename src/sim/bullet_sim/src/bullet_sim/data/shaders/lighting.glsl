struct Light {
    vec4 position;     // world
    vec4 direction;    // world, unit; w: range
    vec4 diffuse;
    vec4 specular;
    vec4 attenuation;  // constant, linear, quadratic
    vec4 cone;         // cos(inner / 2), cos(outer / 2), falloff
};
layout(std140) uniform Lights {
    vec4 scene_ambient;
    vec4 eye;
    Light lights[MAX_LIGHTS];
};
layout(std140) uniform Surface {
    vec4 ambient;
    vec4 diffuse;
    vec4 specular;     // w: shininess, 0: no highlight
    vec4 emissive;     // w: 1 where light counts
    vec4 texture_map;  // scale, offset
};
#ifdef SHADOWS
struct Shadow {
    mat4 map_world;  // to 0..1 in the light's map
    vec4 grain;      // m, of a texel; of a spot light at a depth of 1 m
};
layout(std140) uniform Shadows {
    Shadow shadows[SHADOWS];
};
uniform sampler2DShadow shadow_maps;  // side by side
// A place in a light's map. Smoothing looks a texel away along both axes: a surface stands out by
// more than that, so as to lie in no shadow of its own.
vec4 in_map(int shadow, vec3 position, vec3 normal) {
    float depth = (shadows[shadow].map_world * vec4(position, 1.0)).w;  // 1 in a directional light
    vec3 raised = position + 1.5 * shadows[shadow].grain.x * depth * normal;
    return shadows[shadow].map_world * vec4(raised, 1.0);
}
#ifndef PER_PIXEL
vec3 interceptable[SHADOWS];  // what each of these lights adds, left out of what lit() returns
#endif
float arriving(int shadow, vec3 at) {
    if (any(notEqual(at.xy, clamp(at.xy, 0.0, 1.0)))) return 1.0;
    vec2 place = vec2((at.x + float(shadow)) / float(SHADOWS), at.y);
    return texture(shadow_maps, vec3(place, min(at.z, 1.0)));
}
#endif
vec3 lit(vec3 position, vec3 normal) {
#if defined(SHADOWS) && !defined(PER_PIXEL)
    for (int i = 0; i < SHADOWS; ++i) interceptable[i] = vec3(0.0);
#endif
    if (emissive.w == 0.0) return min(diffuse.rgb + emissive.rgb, 1.0);
    vec3 colour = emissive.rgb + ambient.rgb * scene_ambient.rgb;
    const int kinds[LIGHTS] = KINDS;
    const int casts[LIGHTS] = CASTS;
    for (int i = 0; i < LIGHTS; ++i) {
        Light light = lights[i];
        vec3 towards = -light.direction.xyz;
        float strength = 1.0;
        int kind = kinds[i];
        if (kind >= POINT) {
            vec3 gap = light.position.xyz - position;
            float distance = max(length(gap), 1e-6);
            towards = gap / distance;
            float fall = dot(light.attenuation.xyz, vec3(1.0, distance, distance * distance));
            strength = distance > light.direction.w ? 0.0 : 1.0 / max(fall, 1e-6);
            if (kind == SPOT) {
                float inside = (dot(-towards, light.direction.xyz) - light.cone.y)
                             / max(light.cone.x - light.cone.y, 1e-6);
                inside = clamp(inside, 0.0, 1.0);
                strength *= light.cone.z > 0.0 ? pow(inside, light.cone.z) : step(1e-6, inside);
            }
        }
        float facing = dot(normal, towards);
#ifdef SHADOWS
        int shadow = casts[i];
#ifdef PER_PIXEL
        if (shadow >= 0 && strength > 0.0 && facing > 0.0) {
            vec4 at = in_map(shadow, position, normal);
            if (at.w > 0.0) strength *= arriving(shadow, at.xyz / at.w);  // else behind the light
        }
#else
        vec3 before = colour;
#endif
#endif
        if (facing > 0.0) {
            colour += strength * facing * diffuse.rgb * light.diffuse.rgb;
#ifdef HIGHLIGHT
            if (specular.w > 0.0) {
                vec3 halfway = normalize(towards + normalize(eye.xyz - position));
                float shine = pow(max(dot(normal, halfway), 0.0), specular.w);
                colour += strength * shine * specular.rgb * light.specular.rgb;
            }
#endif
        }
#if defined(SHADOWS) && !defined(PER_PIXEL)
        if (shadow >= 0) {
            interceptable[shadow] = colour - before;
            colour = before;
        }
#endif
    }
#if defined(SHADOWS) && !defined(PER_PIXEL)
    return colour;  // clamped when all has come together
#else
    return min(colour, 1.0);
#endif
}

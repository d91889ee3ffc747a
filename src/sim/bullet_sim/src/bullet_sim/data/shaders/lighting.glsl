struct Light {
    vec4 position;     // world; w: kind
    vec4 direction;    // world, unit; w: range
    vec4 diffuse;
    vec4 specular;
    vec4 attenuation;  // constant, linear, quadratic
    vec4 cone;         // cos(inner / 2), cos(outer / 2), falloff
};
layout(std140) uniform Lights {
    vec4 scene_ambient;
    vec4 eye;
    ivec4 light_count;
    Light lights[MAX_LIGHTS];
};
layout(std140) uniform Surface {
    vec4 ambient;
    vec4 diffuse;
    vec4 specular;     // w: shininess, 0: no highlight
    vec4 emissive;     // w: 1 where light counts
    vec4 texture_map;  // scale, offset
};
vec3 lit(vec3 position, vec3 normal) {
    if (emissive.w == 0.0) return min(diffuse.rgb + emissive.rgb, 1.0);
    vec3 colour = emissive.rgb + ambient.rgb * scene_ambient.rgb;
    for (int i = 0; i < light_count.x; ++i) {
        Light light = lights[i];
        vec3 towards = -light.direction.xyz;
        float strength = 1.0;
        int kind = int(light.position.w);
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
        if (facing > 0.0) {
            colour += strength * facing * diffuse.rgb * light.diffuse.rgb;
            if (specular.w > 0.0) {
                vec3 halfway = normalize(towards + normalize(eye.xyz - position));
                float shine = pow(max(dot(normal, halfway), 0.0), specular.w);
                colour += strength * shine * specular.rgb * light.specular.rgb;
            }
        }
    }
    return min(colour, 1.0);
}

"""GLSL of the scene: one source, with the light worked out per corner or per pixel.

Gazebo's arithmetic: emissive + ambient * scene ambient + sum over lights of diffuse and specular,
clamped to 1, times the texture. No gamma. A surface without highlight under directional lights only
is lit per corner, which is the same on flat faces and leaves little to do for each pixel.
"""

MAX_LIGHTS = 8
DIRECTIONAL, POINT, SPOT = 0, 1, 2
LINEAR, EXP, EXP2 = 0, 1, 2

_LIGHTING = f"""
#define MAX_LIGHTS {MAX_LIGHTS}
#define POINT {POINT}
#define SPOT {SPOT}
""" + """
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
"""

_VERTEX = """
uniform mat4 projection_model;
uniform mat4 model;
in vec3 in_position;
in vec3 in_normal;
in vec2 in_uv;
#ifdef PER_PIXEL
out vec3 position;
out vec3 normal;
#else
out vec3 light;
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
    light = lit(world, normalize(turned));
#endif
#ifdef TEXTURED
    uv = in_uv * texture_map.xy + texture_map.zw;
#endif
}
"""

_FRAGMENT = """
#ifdef PER_PIXEL
in vec3 position;
in vec3 normal;
#else
in vec3 light;
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
"""


def sources(per_pixel: bool, textured: bool, fog: bool = False) -> dict[str, str]:
    """Arguments of moderngl's `program` for one kind of surface, with or without fog."""
    head = "#version 330\n"
    head += f"#define FOG\n#define LINEAR {LINEAR}\n#define EXP {EXP}\n" if fog else ""
    head += "#define PER_PIXEL\n" if per_pixel else ""
    head += "#define TEXTURED\n" if textured else ""
    head += _LIGHTING
    return {"vertex_shader": head + _VERTEX, "fragment_shader": head + _FRAGMENT}

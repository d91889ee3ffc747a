// How surfaces look: Gazebo's arithmetic, so that the view has the colours of the robot's camera.
// emissive + ambient x scene ambient + diffuse and specular of each light, at most 1, x texture.
// Two things help to see shapes: what faces down gets less of the ambient light, and what is no
// floor is brighter where it turns away, so that a dark robot stands out from a dark floor.

import * as THREE from "../vendor/three.module.min.js";

const MOST_LIGHTS = 8;
const KINDS = { directional: 0, point: 1, spot: 2 };

const VERTEX = `
varying vec3 world;
varying vec3 turned;
varying vec2 image;
uniform vec4 mapping;  // scale, offset
void main() {
  world = (modelMatrix * vec4(position, 1.0)).xyz;
  turned = mat3(modelMatrix) * normal;
  image = uv * mapping.xy + mapping.zw;
  gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
}`;

const FRAGMENT = `
struct Light {
  int kind;
  vec3 position;     // m, world
  vec3 direction;    // world, unit
  float range;
  vec3 diffuse;
  vec3 specular;
  vec3 attenuation;  // constant, linear, quadratic
  vec3 cone;         // cosines of half the inner and outer angle, falloff
};
uniform vec3 sceneAmbient;
#if LIGHTS > 0  // as many as there are: processors that draw work out every turn of the loop
uniform Light lights[LIGHTS];
#endif
uniform vec3 ambient;
uniform vec4 diffuse;
uniform vec3 specular;
uniform vec3 emissive;
uniform float shininess;  // 0: no highlight
uniform bool lit;
#ifdef TEXTURED
uniform sampler2D picture;
#endif
varying vec3 world;
varying vec3 turned;
varying vec2 image;

vec3 from(Light light, vec3 normal) {
  vec3 towards = -light.direction;
  float strength = 1.0;
  if (light.kind != ${KINDS.directional}) {
    vec3 gap = light.position - world;
    float away = max(length(gap), 1e-6);
    towards = gap / away;
    float fall = dot(light.attenuation, vec3(1.0, away, away * away));
    strength = away > light.range ? 0.0 : 1.0 / max(fall, 1e-6);
  }
  if (light.kind == ${KINDS.spot}) {
    float inside = (dot(-towards, light.direction) - light.cone.y)
                 / max(light.cone.x - light.cone.y, 1e-6);
    inside = clamp(inside, 0.0, 1.0);
    strength *= light.cone.z > 0.0 ? pow(inside, light.cone.z) : step(1e-6, inside);
  }
  float facing = dot(normal, towards);
  if (facing <= 0.0) return vec3(0.0);
  vec3 colour = facing * diffuse.rgb * light.diffuse;
  if (shininess > 0.0) {
    vec3 halfway = normalize(towards + normalize(cameraPosition - world));
    colour += pow(max(dot(normal, halfway), 0.0), shininess) * specular * light.specular;
  }
  return strength * colour;
}

void main() {
  vec3 normal = normalize(turned);
  float fromSky = 0.8 + 0.2 * min(1.0, 1.0 + normal.z);
  vec3 colour = emissive + (lit ? fromSky * ambient * sceneAmbient : diffuse.rgb);
#if LIGHTS > 0
  if (lit) {
    for (int i = 0; i < LIGHTS; ++i) colour += from(lights[i], normal);
  }
#endif
#ifdef RIM
  float away = 1.0 - abs(dot(normal, normalize(cameraPosition - world)));
  if (lit) colour += vec3(0.12 + 0.4 * away * away);
#endif
  colour = min(colour, 1.0);
#ifdef TEXTURED
  colour *= texture2D(picture, image).rgb;
#endif
  gl_FragColor = vec4(colour, diffuse.a);
}`;

const vector = (numbers) => new THREE.Vector3(...numbers.slice(0, 3));

/** Of every material of one scene; `setLights` changes it for those made afterwards. */
export function lighting() {
  return { sceneAmbient: { value: new THREE.Vector3(1, 1, 1) }, lights: { value: [] } };
}

function uniformsOf(light) {
  const [inner, outer, falloff] = light.cone;
  const direction = vector(light.direction);
  if (direction.lengthSq() > 0) direction.normalize();
  else direction.set(0, 0, -1);
  return {
    kind: KINDS[light.type] ?? KINDS.point, position: vector(light.position), direction,
    range: light.range, diffuse: vector(light.diffuse), specular: vector(light.specular),
    attenuation: vector(light.attenuation),
    cone: new THREE.Vector3(Math.cos(inner / 2), Math.cos(outer / 2), falloff),
  };
}

export function setLights(shared, ambient, lights) {
  shared.sceneAmbient.value = vector(ambient);
  shared.lights.value = lights.slice(0, MOST_LIGHTS).map(uniformsOf);
}

/** `look` as the server's page_scene.py has it; `plane`: rank of a plane by size, or null. */
export function surface(shared, look, picture, plane) {
  const [width, height] = look.texture_scale.map((scale) => (scale ? 1 / scale : 1));
  const material = new THREE.ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    defines: { LIGHTS: shared.lights.value.length, ...(picture && { TEXTURED: "" }),
      ...(plane === null && { RIM: "" }) },
    transparent: look.diffuse[3] < 1,
    depthWrite: look.diffuse[3] >= 1,
    uniforms: {
      ...shared,
      ambient: { value: vector(look.ambient) },
      diffuse: { value: new THREE.Vector4(...look.diffuse) },
      specular: { value: vector(look.specular) },
      emissive: { value: vector(look.emissive) },
      shininess: { value: look.shininess },
      lit: { value: look.lighting },
      picture: { value: picture },
      mapping: { value: new THREE.Vector4(width, height, 0.5 - 0.5 * width, 0.5 - 0.5 * height) },
    },
  });
  if (plane !== null) {
    // Where planes lie in each other, the larger gives way.
    material.polygonOffset = true;
    material.polygonOffsetFactor = plane + 1;
    material.polygonOffsetUnits = 4 * (plane + 1);
  }
  return material;
}

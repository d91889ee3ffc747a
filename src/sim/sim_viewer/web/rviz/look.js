// What several parts need to be drawn: light, widths in pixels, whether one sees through.

import * as THREE from "../vendor/three.module.min.js";

const ONE = new THREE.Vector3(1, 1, 1);

/** GLSL: a colour in the light of this view, brighter from above; `normal` is in the world. */
export const SHADE = `
vec3 shade(vec3 colour, vec3 normal) {
  return colour * (0.72 + 0.28 * dot(normalize(normal), normalize(vec3(0.4, -0.5, 1.0))));
}`;

/** Pixels of a metre at a distance of one metre. */
export function perMetre(renderer, camera) {
  return renderer.domElement.height / 2 * camera.projectionMatrix.elements[5];
}

/** Whether one of the colours (n, 4) is not opaque. */
export function isClear(colours) {
  for (let i = 3; i < colours.length; i += 4) if (colours[i] < 255) return true;
  return false;
}

/** Put an object where a part's pose says. */
export function place(object, pose) {
  object.position.fromArray(pose, 0);
  object.quaternion.fromArray(pose, 3);
}

/** A matrix of x, y, z in m and a quaternion. */
export function matrixOf(row) {
  return new THREE.Matrix4().compose(new THREE.Vector3().fromArray(row),
    new THREE.Quaternion().fromArray(row, 3), ONE);
}

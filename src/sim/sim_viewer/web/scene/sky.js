// The sky, for scenes that have one.

import * as THREE from "../vendor/three.module.min.js";

const HORIZON = [0.8, 0.86, 0.92]; // as the simulator's cameras have them
const ZENITH = [0.3, 0.5, 0.8];

/** A dome round the camera, hidden at first. */
export function skyDome() {
  const material = new THREE.ShaderMaterial({
    side: THREE.BackSide, depthTest: false, depthWrite: false,
    vertexShader: `varying vec3 ray;
      void main() {
        ray = position;
        gl_Position = projectionMatrix * vec4(mat3(viewMatrix) * position, 1.0);
      }`,
    fragmentShader: `varying vec3 ray;
      void main() {
        float height = sqrt(max(normalize(ray).z, 0.0));
        gl_FragColor = vec4(mix(vec3(${HORIZON}), vec3(${ZENITH}), height), 1.0);
      }`,
  });
  const dome = new THREE.Mesh(new THREE.SphereGeometry(1, 32, 16), material);
  dome.frustumCulled = false;
  dome.renderOrder = -1;
  dome.visible = false;
  return dome;
}

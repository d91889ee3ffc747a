// A soft dark patch below each model that stands on something: without it things seem to float.

import * as THREE from "../vendor/three.module.min.js";

const LARGEST = 2; // m, a side of what has one: walls and floors look right without
const WIDER = 1.3; // than the model
const ABOVE = 0.004; // m, what it lies on
const DARK = 0.45;

const GEOMETRY = new THREE.PlaneGeometry(1, 1);
const MATERIAL = new THREE.ShaderMaterial({
  transparent: true, depthWrite: false,
  vertexShader: `varying vec2 place;
    void main() {
      place = 2.0 * uv - 1.0;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`,
  fragmentShader: `varying vec2 place;
    void main() {
      vec2 inwards = 1.0 - smoothstep(0.45, 1.0, abs(place));
      gl_FragColor = vec4(0.0, 0.0, 0.0, ${DARK} * inwards.x * inwards.y);
    }`,
});

export class GroundShadows {
  constructor() {
    this.root = new THREE.Group();
    this._patches = []; // [the model's first link, patch]
  }

  /** Below the models of `links` as they stand now. */
  show(links) {
    this.root.clear();
    this._patches = [];
    links.root.updateMatrixWorld();
    for (const [base, ...others] of links.models.values()) {
      const box = boxOf([base, ...others], base);
      const size = box.getSize(new THREE.Vector3());
      if (box.isEmpty() || Math.max(size.x, size.y) > LARGEST || size.z < 2 * ABOVE) continue;
      const patch = new THREE.Mesh(GEOMETRY, MATERIAL);
      patch.raycast = () => {};
      patch.userData.middle = box.getCenter(new THREE.Vector3()).setZ(box.min.z + ABOVE);
      patch.scale.set(WIDER * size.x, WIDER * size.y, 1);
      this.root.add(patch);
      this._patches.push([base, patch]);
    }
    this.follow();
  }

  /** After the models have moved. */
  follow() {
    for (const [base, patch] of this._patches) {
      patch.quaternion.copy(base.quaternion);
      patch.position.copy(patch.userData.middle).applyQuaternion(base.quaternion)
        .add(base.position);
    }
  }
}

/** Around the meshes of links, in the frame of one. */
function boxOf(links, base) {
  const box = new THREE.Box3();
  const inverse = base.matrixWorld.clone().invert();
  for (const mesh of links.flatMap((link) => link.children)) {
    const matrix = inverse.clone().multiply(mesh.matrixWorld);
    box.union(mesh.geometry.boundingBox.clone().applyMatrix4(matrix));
  }
  return box;
}

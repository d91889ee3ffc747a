// A soft dark patch below each model that stands on something: without it things seem to float.

import * as THREE from "../vendor/three.module.min.js";

const LARGEST = 2; // m, a side of what has one: walls and floors look right without
const WIDER = 1.3; // than the model
const ABOVE = 0.004; // m, what it lies on
const LIFTED = 0.2; // m, above where it stood: there is none below it any more
const DARK = 0.45;

export class GroundShadows {
  constructor() {
    this.root = new THREE.Group();
    this._models = []; // {base, patch, middle}
    this._geometry = new THREE.PlaneGeometry(1, 1);
    this._material = new THREE.ShaderMaterial({
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
  }

  /** Below the models of `links` as they stand now. */
  show(links) {
    this.root.clear();
    this._models = [];
    links.root.updateMatrixWorld();
    for (const [base, ...others] of links.models.values()) {
      const box = boxOf([base, ...others], upright(base));
      const size = box.getSize(new THREE.Vector3());
      if (box.isEmpty() || Math.max(size.x, size.y) > LARGEST || size.z < 2 * ABOVE) continue;
      const patch = new THREE.Mesh(this._geometry, this._material);
      patch.raycast = () => {};
      patch.scale.set(WIDER * size.x, WIDER * size.y, 1);
      patch.position.z = base.position.z + box.min.z + ABOVE;
      this.root.add(patch);
      const middle = box.getCenter(new THREE.Vector3()).setZ(0);
      this._models.push({ base, patch, middle, height: base.position.z });
    }
    this.follow();
  }

  /** After the models have moved: along the ground, turned as they are. */
  follow() {
    for (const { base, patch, middle, height } of this._models) {
      const { z } = patch.position;
      const turned = upright(base);
      patch.quaternion.setFromRotationMatrix(turned);
      patch.position.copy(middle).applyMatrix4(turned).setZ(z);
      patch.visible = Math.abs(base.position.z - height) < LIFTED;
    }
  }

  close() {
    this._geometry.dispose();
    this._material.dispose();
  }
}

/** A link's place, turned about the vertical only. */
function upright(link) {
  const { z } = new THREE.Euler().setFromQuaternion(link.quaternion, "ZYX");
  return new THREE.Matrix4().makeRotationZ(z).setPosition(link.position);
}

/** Around the meshes of links, in a frame. */
function boxOf(links, frame) {
  const box = new THREE.Box3();
  const inverse = frame.clone().invert();
  for (const mesh of links.flatMap((link) => link.children)) {
    const matrix = inverse.clone().multiply(mesh.matrixWorld);
    box.union(mesh.geometry.boundingBox.clone().applyMatrix4(matrix));
  }
  return box;
}

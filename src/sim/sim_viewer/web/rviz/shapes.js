// Cubes, spheres, cylinders and cones of diameter and height 1, many at once.

import * as THREE from "../vendor/three.module.min.js";
import { isClear, SHADE } from "./look.js";

const ROW = 10; // numbers of one: place, quaternion, scale
const SIDES = 20;

const upright = (geometry) => geometry.rotateX(Math.PI / 2); // along z
const SHAPES = {
  cube: new THREE.BoxGeometry(1, 1, 1),
  sphere: new THREE.SphereGeometry(0.5, SIDES, SIDES / 2),
  cylinder: upright(new THREE.CylinderGeometry(0.5, 0.5, 1, SIDES)),
  cone: upright(new THREE.ConeGeometry(0.5, 1, SIDES)),
};

const VERTEX = `
attribute vec4 tint;
varying vec4 colour;
varying vec3 turned;
void main() {
  mat4 placed = modelMatrix * instanceMatrix;
  colour = tint;
  turned = transpose(inverse(mat3(placed))) * normal;
  gl_Position = projectionMatrix * viewMatrix * placed * vec4(position, 1.0);
}`;
const FRAGMENT = `
varying vec4 colour;
varying vec3 turned;
${SHADE}
void main() { gl_FragColor = vec4(shade(colour.rgb, turned), colour.a); }`;

export class ShapesPart {
  constructor() {
    this.object = new THREE.Group();
    this._material = new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT });
  }

  update({ arrays, shape }) {
    const { rows, colour } = arrays;
    const count = rows.length / ROW;
    if (this._mesh?.count !== count || this._shape !== shape) this._begin(shape, count);
    this._material.transparent = isClear(colour);
    this._material.depthWrite = !this._material.transparent;
    const [at, turn, scale] = [new THREE.Vector3(), new THREE.Quaternion(), new THREE.Vector3()];
    const matrix = new THREE.Matrix4();
    for (let i = 0; i < count; i++) {
      at.fromArray(rows, ROW * i);
      turn.fromArray(rows, ROW * i + 3);
      scale.fromArray(rows, ROW * i + 7);
      this._mesh.setMatrixAt(i, matrix.compose(at, turn, scale));
    }
    this._mesh.instanceMatrix.needsUpdate = true;
    this._mesh.geometry.setAttribute("tint", new THREE.InstancedBufferAttribute(colour, 4, true));
    this._mesh.boundingSphere = null; // or rays would be tested against where things were
  }

  dispose() {
    this._end();
    this._material.dispose();
  }

  _begin(shape, count) {
    this._end();
    this._shape = shape;
    this._mesh = new THREE.InstancedMesh(SHAPES[shape].clone(), this._material, count);
    this._mesh.frustumCulled = false;
    this.object.add(this._mesh);
  }

  _end() {
    if (!this._mesh) return;
    this._mesh.removeFromParent();
    this._mesh.geometry.dispose();
    this._mesh.dispose();
  }
}

// Triangles with a colour at each corner, seen from both sides.

import * as THREE from "../vendor/three.module.min.js";
import { isClear, SHADE } from "./look.js";

const VERTEX = `
attribute vec4 tint;
varying vec4 colour;
varying vec3 world;
void main() {
  colour = tint;
  world = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
}`;
const FRAGMENT = `
varying vec4 colour;
varying vec3 world;
${SHADE}
void main() {
  vec3 normal = cross(dFdx(world), dFdy(world));
  gl_FragColor = vec4(shade(colour.rgb, normal), colour.a);
}`;

export class TrianglesPart {
  constructor() {
    this._material = new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT,
      side: THREE.DoubleSide });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), this._material);
    this.object.frustumCulled = false;
  }

  update({ arrays }) {
    this._material.transparent = isClear(arrays.colour);
    this._material.depthWrite = !this._material.transparent;
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setAttribute("position", new THREE.BufferAttribute(arrays.position, 3));
    this.object.geometry.setAttribute("tint", new THREE.BufferAttribute(arrays.colour, 4, true));
  }

  dispose() {
    this.object.geometry.dispose();
    this._material.dispose();
  }
}

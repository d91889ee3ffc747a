// Lines between pairs of points, as wide as they are in m, and never so thin that they vanish.

import * as THREE from "../vendor/three.module.min.js";
import { isClear, perMetre } from "./look.js";

const THINNEST = 1.5; // px
const NEAR = 0.02; // m

const VERTEX = `
attribute vec3 first, last;
attribute vec4 firstTint, lastTint;
uniform float width, perMetre, thinnest;
uniform vec2 pixels;
varying vec4 colour;
void main() {
  vec4 a = modelViewMatrix * vec4(first, 1.0);
  vec4 b = modelViewMatrix * vec4(last, 1.0);
  colour = mix(firstTint, lastTint, position.y);
  // What lies behind the camera is cut off.
  if (a.z > -${NEAR}) a = mix(a, b, clamp((-${NEAR} - a.z) / (b.z - a.z), 0.0, 1.0));
  else if (b.z > -${NEAR}) b = mix(b, a, clamp((-${NEAR} - b.z) / (a.z - b.z), 0.0, 1.0));
  vec4 from = projectionMatrix * a;
  vec4 to = projectionMatrix * b;
  vec2 along = (to.xy / to.w - from.xy / from.w) * pixels;
  along = dot(along, along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  gl_Position = position.y < 0.5 ? from : to;
  float wide = max(width * perMetre / gl_Position.w, thinnest);
  // Half a width longer at both ends, so that bends have no gaps.
  vec2 off = position.x * vec2(-along.y, along.x) + (2.0 * position.y - 1.0) * along;
  gl_Position.xy += off * wide / pixels * gl_Position.w;
}`;
const FRAGMENT = `
varying vec4 colour;
void main() { gl_FragColor = colour; }`;

const QUAD = new THREE.BufferAttribute(
  new Float32Array([-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0]), 3);

export class LinesPart {
  constructor() {
    this._material = new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT,
      side: THREE.DoubleSide, uniforms: { width: { value: 0 }, perMetre: { value: 1 },
        thinnest: { value: THINNEST }, pixels: { value: new THREE.Vector2(1, 1) } } });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), this._material);
    this.object.frustumCulled = false;
    this.object.raycast = () => {};
    this.object.onBeforeRender = (renderer, scene, camera) => {
      const { uniforms } = this._material;
      uniforms.perMetre.value = perMetre(renderer, camera);
      uniforms.thinnest.value = Math.max(1, THINNEST * renderer.getPixelRatio());
      uniforms.pixels.value.set(renderer.domElement.width, renderer.domElement.height);
      this._material.uniformsNeedUpdate = true;
    };
  }

  update({ arrays, width }) {
    this._material.uniforms.width.value = width;
    this._material.transparent = isClear(arrays.colour);
    this._material.depthWrite = !this._material.transparent;
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute("position", QUAD);
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const ends = new THREE.InstancedInterleavedBuffer(arrays.position, 6);
    const tints = new THREE.InstancedInterleavedBuffer(arrays.colour, 8);
    const add = (name, buffer, size, at, normalized) => geometry.setAttribute(name,
      new THREE.InterleavedBufferAttribute(buffer, size, at, normalized));
    add("first", ends, 3, 0);
    add("last", ends, 3, 3);
    add("firstTint", tints, 4, 0, true);
    add("lastTint", tints, 4, 4, true);
    geometry.instanceCount = arrays.position.length / 6;
    this.object.geometry.dispose();
    this.object.geometry = geometry;
  }

  dispose() {
    this.object.geometry.dispose();
    this._material.dispose();
  }
}

// Points: squares or discs that face the camera, of a size in m or in pixels.

import * as THREE from "../vendor/three.module.min.js";
import { isClear, perMetre } from "./look.js";

const VERTEX = `
attribute vec4 tint;
uniform float size, perMetre, least;
uniform bool inPixels;
varying vec4 colour;
void main() {
  colour = tint;
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  gl_PointSize = inPixels ? size * least : max(size * perMetre / gl_Position.w, least * 1.5);
}`;
const FRAGMENT = `
uniform bool disc;
varying vec4 colour;
void main() {
  vec2 off = gl_PointCoord - 0.5;
  float away = dot(off, off);
  if (disc && away > 0.25) discard;
  gl_FragColor = vec4(disc ? colour.rgb * (1.0 - 1.6 * away) : colour.rgb, colour.a);
}`;

export class PointsPart {
  constructor() {
    this._material = new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT,
      uniforms: { size: { value: 1 }, perMetre: { value: 1 }, least: { value: 1 },
        inPixels: { value: false }, disc: { value: false } } });
    this.object = new THREE.Points(new THREE.BufferGeometry(), this._material);
    this.object.frustumCulled = false;
    this.object.raycast = (rays, hits) => nearest(this.object, rays, hits);
    this.object.onBeforeRender = (renderer, scene, camera) => {
      this._material.uniforms.perMetre.value = perMetre(renderer, camera);
      this._material.uniforms.least.value = renderer.getPixelRatio();
      this._material.uniformsNeedUpdate = true;
    };
  }

  update({ arrays, size, unit, round }) {
    const { uniforms } = this._material;
    uniforms.size.value = size;
    uniforms.inPixels.value = unit === "px";
    uniforms.disc.value = round;
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

/** The first of the points that a ray comes as near to as 1 % of their distance. */
function nearest(points, rays, hits) {
  const { position } = points.geometry.attributes;
  const place = new THREE.Vector3();
  let best = null;
  for (let i = 0; i < position.count; i++) {
    place.fromBufferAttribute(position, i).applyMatrix4(points.matrixWorld);
    const distance = place.distanceTo(rays.ray.origin);
    if (best && distance >= best.distance) continue;
    if (rays.ray.distanceSqToPoint(place) > (0.01 * distance) ** 2) continue;
    best = { distance, point: place.clone(), object: points };
  }
  if (best) hits.push(best);
}

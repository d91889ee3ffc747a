// An occupancy grid on the floor: a texture of cells, and the colours that rviz gives them.

import * as THREE from "../vendor/three.module.min.js";

const UNKNOWN = [0x70, 0x89, 0x86, 255];
const BAD = [0, 255, 0, 255]; // more than 100
const grey = (value) => [value, value, value, 255];
const SCHEMES = {
  raw: grey,
  map: (i) => (i <= 100 ? grey(255 - Math.floor(255 * i / 100)) : odd(i)),
  costmap: (i) => {
    if (i === 0) return [0, 0, 0, 0];
    if (i < 99) return [Math.floor(255 * i / 100), 0, 255 - Math.floor(255 * i / 100), 255];
    return i === 99 ? [0, 255, 255, 255] : i === 100 ? [255, 0, 255, 255] : odd(i);
  },
};

/** What no map should have: more than 100, or negative, but for -1. */
function odd(i) {
  if (i === 255) return UNKNOWN;
  return i <= 127 ? BAD : [255, Math.floor(255 * (i - 128) / (254 - 128)), 0, 255];
}

function palette(scheme) {
  const colours = new Uint8Array(Array.from({ length: 256 }, (_, i) => SCHEMES[scheme](i)).flat());
  return texture(colours, 256, 1, THREE.RGBAFormat);
}

function texture(data, width, height, format) {
  const made = new THREE.DataTexture(data, width, height, format);
  made.unpackAlignment = 1;
  made.needsUpdate = true;
  return made;
}

const VERTEX = `
varying vec2 cell;
void main() {
  cell = uv;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = `
uniform sampler2D cells, palette;
uniform float alpha;
varying vec2 cell;
void main() {
  vec4 colour = texture2D(palette, vec2((texture2D(cells, cell).r * 255.0 + 0.5) / 256.0, 0.5));
  gl_FragColor = vec4(colour.rgb, colour.a * alpha);
}`;

export class MapPart {
  constructor() {
    this._uniforms = { cells: { value: null }, palette: { value: null }, alpha: { value: 1 } };
    const material = new THREE.ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT,
      uniforms: this._uniforms, transparent: true, depthWrite: false, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 });
    this.object = new THREE.Group();
    // From the map's origin on, which is a corner.
    this._plane = new THREE.Mesh(new THREE.PlaneGeometry(1, 1).translate(0.5, 0.5, 0), material);
    this.object.add(this._plane);
  }

  update({ arrays, width, height, size, scheme, alpha, behind }) {
    if (arrays) {
      this._uniforms.cells.value?.dispose();
      this._uniforms.cells.value = texture(arrays.cells, width, height, THREE.RedFormat);
    }
    if (this._scheme !== scheme) {
      this._uniforms.palette.value?.dispose();
      this._uniforms.palette.value = palette(scheme);
      this._scheme = scheme;
    }
    this._uniforms.alpha.value = alpha;
    this._plane.scale.set(...size, 1);
    this._plane.renderOrder = behind ? -0.5 : 0;
  }

  dispose() {
    this._uniforms.cells.value?.dispose();
    this._uniforms.palette.value?.dispose();
    this._plane.geometry.dispose();
    this._plane.material.dispose();
  }
}

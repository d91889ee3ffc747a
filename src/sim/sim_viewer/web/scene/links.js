// The links of the scene: their triangles and textures from the server, and where they are.

import * as THREE from "../vendor/three.module.min.js";
import { lighting, setLights, surface } from "./material.js";

const HEAD_BYTES = 16; // of /mesh/N: four uint32
const SHARPNESS = 8; // samples, of textures seen at a flat angle

async function loadGeometry(address) {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
  const data = await answer.arrayBuffer();
  const [corners, triangles, hasUv] = new Uint32Array(data, 0, 4);
  let at = HEAD_BYTES;
  const floats = (count) => {
    const values = new Float32Array(data, at, count);
    at += 4 * count;
    return values;
  };
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(floats(3 * corners), 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(floats(3 * corners), 3));
  if (hasUv) geometry.setAttribute("uv", new THREE.BufferAttribute(floats(2 * corners), 2));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(data, at, 3 * triangles), 1));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

function loadTexture(address) {
  return new THREE.TextureLoader().loadAsync(address).then((texture) => {
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.anisotropy = SHARPNESS;
    return texture;
  });
}

/** Everything by name; `onChange()` when models or meshes are new; `address(path)`: what to load for
 * `mesh/N` or `texture/N`. */
export class Links {
  constructor(onChange, address = (path) => path) {
    this.root = new THREE.Group();
    this.models = new Map(); // name -> its links
    this._onChange = onChange;
    this._address = address;
    this._shared = lighting();
    this._links = new Map();
    this._geometries = new Map(); // number -> promise
    this._textures = new Map();
    this._order = [];
  }

  /** Another scene; meshes that the last one had, too, are kept. */
  show(scene) {
    setLights(this._shared, scene.ambient, scene.lights);
    this.root.traverse((mesh) => mesh.material?.dispose());
    this.root.clear();
    this._links = new Map();
    this.models = new Map();
    for (const link of scene.links) {
      const group = this._group(link);
      this._links.set(link.name, group);
      this.root.add(group);
      if (link.model) {
        if (!this.models.has(link.model)) this.models.set(link.model, []);
        this.models.get(link.model).push(group);
      }
    }
    this._forget(scene);
    this._onChange();
  }

  /** In which order `move` gives poses. */
  name(names) {
    this._order = names;
  }

  /** `rows` is a Float32Array of x, y, z and the quaternion x, y, z, w for each name. */
  move(rows) {
    this._order.forEach((name, i) => {
      const group = this._links.get(name);
      if (!group) return;
      group.position.fromArray(rows, 7 * i);
      group.quaternion.fromArray(rows, 7 * i + 3);
    });
  }

  /** A sphere around a model's links, or around all that is not larger than `largest` m. */
  bounds(model, largest = Infinity) {
    const box = new THREE.Box3();
    this.root.updateMatrixWorld();
    for (const group of model ? this.models.get(model) ?? [] : this._links.values()) {
      for (const mesh of group.children) {
        if (mesh.geometry.boundingSphere.radius > largest) continue;
        box.union(mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrixWorld));
      }
    }
    return box.isEmpty() ? null : box.getBoundingSphere(new THREE.Sphere());
  }

  _group(link) {
    const group = new THREE.Group();
    group.name = link.name;
    group.position.fromArray(link.pose, 0);
    group.quaternion.fromArray(link.pose, 3);
    for (const part of link.parts) this._addPart(group, part, link.plane);
    return group;
  }

  async _addPart(group, part, plane) {
    try {
      const look = part.material;
      const [geometry, picture] = await Promise.all([
        once(this._geometries, part.mesh,
          (number) => loadGeometry(this._address(`mesh/${number}`))),
        look.texture === null ? null : once(this._textures, look.texture,
          (number) => loadTexture(this._address(`texture/${number}`)))
          .catch(() => null),
      ]);
      const textured = geometry.hasAttribute("uv") ? picture : null;
      group.add(new THREE.Mesh(geometry, surface(this._shared, look, textured, plane)));
      this._onChange();
    } catch (error) {
      console.warn(error.message); // a scene that was replaced before its meshes came
    }
  }

  _forget(scene) {
    const parts = scene.links.flatMap((link) => link.parts);
    keep(this._geometries, new Set(parts.map((part) => part.mesh)));
    keep(this._textures, new Set(parts.map((part) => part.material.texture)));
  }
}

function once(kept, number, load) {
  if (!kept.has(number)) {
    const loading = load(number);
    loading.catch(() => kept.delete(number));
    kept.set(number, loading);
  }
  return kept.get(number);
}

function keep(kept, wanted) {
  for (const [number, loading] of kept) {
    if (wanted.has(number)) continue;
    kept.delete(number);
    loading.then((made) => made.dispose(), () => {});
  }
}

// Two runs in one 3D view: their paths, and the other's robot, in a colour each.

import { Links } from "../scene/links.js";
import * as THREE from "../vendor/three.module.min.js";

export const COLOURS = ["#1f6feb", "#f08c00"]; // of this run, of the other
const SHARE = 0.003; // of the path's extent: its width
const ABOVE = 0.01; // m, of the ground that it is drawn on

/** A ribbon along `places`, flat on the ground. */
function ribbon(places, colour) {
  const box = new THREE.Box3().setFromPoints(places.map((place) => new THREE.Vector3(...place)));
  const half = Math.max(0.004, SHARE / 2 * box.getSize(new THREE.Vector3()).length());
  const corners = [];
  const triangles = [];
  let side = [0, half];
  places.forEach(([x, y], i) => {
    const [a, b] = [places[Math.max(i - 1, 0)], places[Math.min(i + 1, places.length - 1)]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length > 0) side = [half * (a[1] - b[1]) / length, half * (b[0] - a[0]) / length];
    corners.push(x + side[0], y + side[1], box.min.z + ABOVE, x - side[0], y - side[1],
      box.min.z + ABOVE);
    if (i) triangles.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(triangles);
  return new THREE.Mesh(geometry,
    new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide }));
}

/** `root` for the view, and `move(time)`. */
export class Overlay {
  /** `redraw()` is called when a mesh has come. */
  constructor(redraw) {
    this._redraw = redraw;
    this.root = new THREE.Group();
    this._links = null;
  }

  /** The motions of two runs; without a second one nothing is drawn. */
  show(motion, other) {
    this.root.clear();
    this._links = null;
    if (!other) return;
    const ghost = new THREE.MeshBasicMaterial({
      color: COLOURS[1], transparent: true, opacity: 0.55 });
    const links = new Links(() => {
      links.root.traverse((one) => {
        if (one.isMesh) one.material = ghost;
      });
      this._redraw();
    }, (path) => other.address(path));
    const robot = other.run.scene.links.filter((link) => link.model === other.robot);
    links.show({ ...other.run.scene, links: robot });
    links.name(other.run.names);
    this._links = links;
    this._other = other;
    this.root.add(ribbon(motion.path(), COLOURS[0]), ribbon(other.path(), COLOURS[1]), links.root);
  }

  move(time) {
    this._links?.move(this._other.rowsAt(time));
  }
}

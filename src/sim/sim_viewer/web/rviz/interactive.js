// rviz/InteractiveMarkers: controls that stand where their markers are, or face the viewer.

import * as THREE from "../vendor/three.module.min.js";
import { Hand } from "./hand.js";
import { matrixOf } from "./look.js";
import { Shown } from "./shown.js";

const FIXED = 1, FACING = 2; // how a control is turned; else as its marker
const SETTLE_MS = 500; // until the server's pose is shown again after a drag
const ONE = new THREE.Vector3(1, 1, 1);
// From a camera's axes to x towards the viewer and z up.
const TO_VIEWER = new THREE.Quaternion(-0.5, -0.5, -0.5, 0.5);

export class ShownInteractive extends Shown {
  constructor(display, link, viewport, onStatus) {
    super(display, link, viewport, onStatus);
    this._markers = [];
    this._drawn = []; // parts, as the server has them
    this._held = new Map(); // by a marker's key: the pose that a hand has given it
  }

  start(frame) {
    super.start(frame);
    this._stopMoving = this._viewport.onMove(() => this._arrange());
    if (this._link.control) {
      this._hand = new Hand(this, this._viewport, (operation, message) => this._link.call(operation,
        { ...message, display: this._args.display }), (reason) => this._complain(reason));
    }
  }

  stop() {
    this._hand?.close();
    this._stopMoving?.();
    super.stop();
  }

  get aids() {
    return this._display.options["Show Visual Aids"];
  }

  /** `{marker, control, point}` below an event's pixel, or null. */
  hit(event) {
    const found = this._viewport.hit(event, this.group);
    let object = found?.object;
    while (object && !object.userData.owner) object = object.parent;
    const owner = object?.userData.owner;
    const marker = this._markers[owner?.marker];
    return marker ? { marker, control: marker.controls[owner.control], point: found.point } : null;
  }

  /** A marker as it is now; undefined if it has gone. */
  find(key) {
    return this._markers.find((one) => one.key === key);
  }

  /** In its header's frame: `[x, y, z, and the quaternion]`. */
  poseOf(marker) {
    return this._held.get(marker.key) ?? marker.pose;
  }

  /** A hand has put a marker there. */
  hold(key, pose) {
    this._held.set(key, pose);
    this._arrange();
    this._viewport.draw();
  }

  /** The hand has let go: the server's pose is shown once that has had time to come. */
  release(key) {
    const held = this._held.get(key);
    setTimeout(() => {
      if (!held || this._held.get(key) !== held) return; // taken again
      this._held.delete(key);
      this._arrange();
      this._viewport.draw();
    }, SETTLE_MS);
  }

  /** How a control's axis is turned, in the fixed frame. */
  turnOf(marker, control) {
    if (control.facing === FACING) {
      const own = new THREE.Quaternion().fromArray(control.orientation).invert();
      return this._viewport.turn.clone().multiply(TO_VIEWER).multiply(own);
    }
    return this._rowTurn(marker, control.facing === FIXED);
  }

  _rowTurn(marker, fixed) {
    const turn = new THREE.Quaternion().fromArray(marker.place, 3);
    return fixed ? turn : turn.multiply(new THREE.Quaternion().fromArray(this.poseOf(marker), 3));
  }

  _show([head, ...parts]) {
    this._markers = head?.markers ?? [];
    this._drawn = parts;
    super._show(parts);
    parts.forEach(({ marker, control }, i) => {
      const { object } = this._parts[i].drawn;
      object.userData.owner = { marker, control };
      object.traverse((one) => { // words can be clicked here
        if (one.isSprite) delete one.raycast;
      });
    });
    this._arrange();
  }

  /** Each control's parts where they belong. */
  _arrange() {
    this._drawn.forEach((part, i) => {
      const marker = this._markers[part.marker];
      const control = marker.controls[part.control];
      const frame = matrixOf(marker.place).multiply(matrixOf(this.poseOf(marker)));
      const turn = control.independent ? this._rowTurn(marker, false)
        : this.turnOf(marker, control);
      const { object } = this._parts[i].drawn;
      new THREE.Matrix4().compose(new THREE.Vector3().setFromMatrixPosition(frame), turn, ONE)
        .multiply(matrixOf(part.pose)).decompose(object.position, object.quaternion, object.scale);
      object.updateMatrixWorld(); // a click may come before the next picture
    });
  }

  _complain(reason) {
    if (this._stop) this._onStatus([["Feedback", "error", reason]]);
  }
}

// The pointer on interactive markers: drags, clicks and menus become feedback for their server.

import * as THREE from "../vendor/three.module.min.js";
import { DRAGS, sizeOfPixel } from "./dragging.js";
import { LinesPart } from "./lines.js";
import { matrixOf } from "./look.js";
import { Menu } from "./menu.js";

const NONE = 0, MENU = 1, BUTTON = 2; // modes of a control
const GREY = [128, 128, 128, 255];
const BELOW = 10; // px, by which the size of one is found
const ALIVE_MS = 250; // between words that a marker is still held

export class Hand {
  /** `call(operation, message)` gives a promise; `complain(reason)` where it fails. */
  constructor(shown, viewport, call, complain) {
    Object.assign(this, { _shown: shown, _viewport: viewport, _call: call, _complain: complain });
    this._queue = [];
    this._events = { pointerdown: (event) => this._press(event),
      pointermove: (event) => this._move(event), pointerup: (event) => this._end(event),
      pointercancel: (event) => this._end(event) };
    for (const [name, listener] of Object.entries(this._events)) {
      viewport.canvas.addEventListener(name, listener, true); // before the camera's
    }
  }

  close() {
    this._closed = true;
    this._end();
    this._menu?.close();
    for (const [name, listener] of Object.entries(this._events)) {
      this._viewport.canvas.removeEventListener(name, listener, true);
    }
    this._viewport.canvas.style.cursor = "";
  }

  _press(event) {
    this._menu?.close();
    if (this._held || !this._viewport.movable) return; // a tool has the pointer
    const hit = this._shown.hit(event);
    if (!hit || hit.control.mode === NONE && event.button !== 2) return;
    if (event.button === 2 && hit.marker.menu) {
      event.stopImmediatePropagation();
      this._open(event, hit);
    } else if (event.button === 0) {
      event.stopImmediatePropagation();
      this._viewport.canvas.setPointerCapture(event.pointerId);
      this._grasp(event, hit);
    }
  }

  _grasp(event, { marker, control, point }) {
    this._held = { key: marker.key, control, at: [event.clientX, event.clientY],
      behind: [0, 0], // px that the pointer has gone on without what it holds
      turn: this._shown.turnOf(marker, control),
      point: this._inFrame(marker, point) }; // where the marker is held
    this._held.pixel = sizeOfPixel(this._grip(marker, event),
      this._ray(marker, event.clientX, event.clientY + BELOW), BELOW);
    this._tell("MOUSE_DOWN", this._held.point);
    this._alive = setInterval(() => this._queue.length || this._tell("KEEP_ALIVE"), ALIVE_MS);
  }

  _move(event) {
    if (!this._held) {
      if (!event.buttons) this._hover(event);
      return;
    }
    event.stopImmediatePropagation();
    const { key, control, behind } = this._held;
    const marker = this._shown.find(key);
    const drag = DRAGS[control.mode];
    if (!marker || !drag) return;
    const grip = this._grip(marker, event);
    const ray = this._ray(marker, event.clientX - behind[0], event.clientY - behind[1]);
    if (drag(grip, ray, event)) {
      behind[0] += grip.moved.x;
      behind[1] += grip.moved.y;
    }
    this._held.point = grip.point;
    this._held.at = [event.clientX, event.clientY];
    this._shown.hold(key, [...grip.position.toArray(), ...grip.turn.normalize().toArray()]);
    this._help(marker, grip.aid);
    this._tell("POSE_UPDATE", grip.point);
  }

  _end(event) {
    if (!this._held) return;
    event?.stopImmediatePropagation();
    clearInterval(this._alive);
    this._help(null);
    const { key, control, point } = this._held;
    this._tell("MOUSE_UP", point);
    const hit = event?.type === "pointerup" && this._shown.hit(event);
    if (hit && hit.marker.key === key && hit.control.name === control.name) {
      if (control.mode === BUTTON) this._tell("BUTTON_CLICK", point);
      if (control.mode === MENU) this._open(event, hit);
    }
    this._held = null;
    this._shown.release(key);
  }

  _hover(event) {
    const hit = this._viewport.movable && this._shown.hit(event);
    this._viewport.canvas.style.cursor = hit && hit.control.mode !== NONE ? "pointer" : "";
  }

  async _open(event, { marker, control, point }) {
    const at = this._inFrame(marker, point);
    try {
      const entries = await this._call("rviz_menu", { marker: marker.key });
      if (this._closed) return; // meanwhile
      this._menu?.close();
      this._menu = new Menu(this._viewport.canvas.parentElement, event, entries,
        (entry) => this._say(marker, control, "MENU_SELECT", at, { entry }));
    } catch (error) {
      this._complain(error.message);
    }
  }

  /** What dragging.js works with, in the marker's header frame. */
  _grip(marker, event) {
    const back = new THREE.Quaternion().fromArray(marker.place, 3).invert();
    const { control, turn, point, at, pixel } = this._held;
    const own = new THREE.Quaternion().fromArray(control.orientation);
    const pose = this._shown.poseOf(marker);
    const seen = (x, y, z) => new THREE.Vector3(x, y, z).applyQuaternion(this._viewport.turn)
      .applyQuaternion(back);
    return { position: new THREE.Vector3().fromArray(pose),
      turn: new THREE.Quaternion().fromArray(pose, 3), point: point.clone(),
      axis: new THREE.Vector3(1, 0, 0).applyQuaternion(own).applyQuaternion(turn)
        .applyQuaternion(back).normalize(),
      towards: seen(0, 0, 1), right: seen(1, 0, 0), up: seen(0, 1, 0),
      moved: { x: event.clientX - at[0], y: event.clientY - at[1] }, pixel };
  }

  /** Through a pixel, in the marker's header frame. */
  _ray(marker, clientX, clientY) {
    return this._viewport.ray({ clientX, clientY }).applyMatrix4(matrixOf(marker.place).invert());
  }

  _inFrame(marker, point) {
    return point.clone().applyMatrix4(matrixOf(marker.place).invert());
  }

  /** rviz's visual aids: a line between two places while something is dragged. */
  _help(marker, ends) {
    this._line?.object.removeFromParent();
    this._line?.dispose();
    this._line = null;
    if (!marker || !ends || !this._shown.aids) return;
    const frame = matrixOf(marker.place);
    this._line = new LinesPart();
    this._line.update({ width: 0, arrays: { colour: new Uint8Array([...GREY, ...GREY]),
      position: new Float32Array(ends.flatMap((end) => end.applyMatrix4(frame).toArray())) } });
    this._viewport.root.add(this._line.object);
  }

  _tell(event, point) {
    const marker = this._shown.find(this._held.key);
    if (marker) this._say(marker, this._held.control, event, point);
  }

  _say(marker, control, event, point, more = {}) {
    // What is not sent yet is not needed once there is a newer pose.
    if (event === "POSE_UPDATE" && this._queue.at(-1)?.event === event) this._queue.pop();
    this._queue.push({ marker: marker.key, control: control.name, event,
      pose: this._shown.poseOf(marker), point: point?.toArray() ?? [], ...more });
    this._flush();
  }

  /** One after the other, so that none overtakes another. */
  async _flush() {
    if (this._busy) return;
    this._busy = true;
    while (this._queue.length) {
      try {
        await this._call("rviz_feedback", this._queue.shift());
      } catch (error) {
        this._complain(error.message);
      }
    }
    this._busy = false;
  }
}

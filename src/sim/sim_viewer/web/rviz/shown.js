// One display that is watched: its frames become objects in the view, its statuses a list.

import * as THREE from "../vendor/three.module.min.js";
import { decodeFrame } from "./frame.js";
import { place } from "./look.js";
import { PARTS } from "./parts.js";

let next = 1; // the server's number for a display; each start has another one

export class Shown {
  /** `display` as session.js has it; `onStatus(statuses)` for each change. */
  constructor(display, link, viewport, onStatus) {
    this._display = display;
    this._link = link;
    this._viewport = viewport;
    this._onStatus = onStatus;
    this._parts = []; // {kind, drawn}
    this.group = new THREE.Group();
    this.group.name = display.name;
  }

  start(frame) {
    const { class: kind, topic, options } = this._display;
    // When the connection comes back, the link watches by these again.
    this._args = { display: next++, class: kind, options, frame, ...(topic && { topic }) };
    this._viewport.root.add(this.group);
    this._stop = this._link.watch("rviz_display", this._args, (data) => this._take(data),
      (reason) => this._onStatus([["Display", "error", reason]]));
  }

  stop() {
    this._stop?.();
    this._stop = null;
    this._show([]);
    this.group.removeFromParent();
    this._viewport.draw();
  }

  /** Other options, or another fixed frame. */
  change(frame) {
    Object.assign(this._args, { options: this._display.options, frame });
    const { display, options } = this._args;
    this._link.call("rviz_change", { display, options, frame }).catch((error) =>
      this._onStatus([["Display", "error", error.message]]));
  }

  async _take(data) {
    if (!(data instanceof DataView)) {
      this._onStatus(data.status, data.namespaces);
      return;
    }
    const { number, parts } = decodeFrame(data);
    try {
      await this._draw(parts);
    } finally { // or it would be the last one
      this._link.tell("rviz_drawn", { display: this._args.display, frame: number });
    }
  }

  async _draw(parts) {
    try {
      this._show(parts);
    } finally {
      await this._viewport.drawn();
    }
  }

  _show(parts) {
    parts.forEach((part, i) => {
      if (this._parts[i]?.kind !== part.kind) this._replace(i, part.kind);
      const { drawn } = this._parts[i];
      drawn.update(part);
      place(drawn.object, part.pose);
    });
    for (const { drawn } of this._parts.splice(parts.length)) this._remove(drawn);
  }

  _replace(i, kind) {
    if (this._parts[i]) this._remove(this._parts[i].drawn);
    const drawn = new PARTS[kind](() => this._viewport.draw());
    this.group.add(drawn.object);
    this._parts[i] = { kind, drawn };
  }

  _remove(drawn) {
    drawn.object.removeFromParent();
    drawn.dispose();
  }
}

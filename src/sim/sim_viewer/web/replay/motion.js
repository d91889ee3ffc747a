// Where everything was in a recorded run, and what it is called.

import { robotOf } from "../scene.js";

export class Motion {
  /** `run`: the data in a run.html. */
  constructor(run) {
    this.run = run;
    this.times = run.times;
    this.first = run.times[0];
    this.last = run.times.at(-1);
    this._poses = new Float32Array(
      Uint8Array.from(atob(run.poses), (letter) => letter.charCodeAt(0)).buffer);
    this._width = 7 * run.names.length;
    const models = new Map();
    for (const link of run.scene.links) {
      if (link.model) models.set(link.model, [...(models.get(link.model) ?? []), link]);
    }
    this.robot = robotOf({ models });
  }

  /** Poses of all links at a time, between two moments that were recorded. */
  rowsAt(time) {
    const { times, _poses: poses, _width: width } = this;
    let next = times.findIndex((one) => one >= time);
    if (next < 0) next = times.length - 1;
    const before = Math.max(next - 1, 0);
    const share = next > before ? (time - times[before]) / (times[next] - times[before]) : 1;
    const rows = new Float32Array(width);
    for (let at = 0; at < width; at += 7) {
      const [a, b] = [before, next].map(
        (row) => poses.subarray(row * width + at, row * width + at + 7));
      const turned = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6] < 0 ? -1 : 1;
      for (let i = 0; i < 7; i += 1) {
        rows[at + i] = a[i] + share * ((i < 3 ? 1 : turned) * b[i] - a[i]);
      }
    }
    return rows;
  }

  /** The robot's places, `[x, y, z]` in m, one for each moment. */
  path() {
    const at = 7 * this.run.names.findIndex((name) => name.startsWith(`${this.robot}::`));
    return at < 0 ? [] : this.times.map((_, row) =>
      [...this._poses.subarray(row * this._width + at, row * this._width + at + 3)]);
  }

  /** Where the 3D view finds a mesh or a texture; a texture that nobody could read: nothing. */
  address(path) {
    return this.run.files[path] ?? "data:,";
  }
}

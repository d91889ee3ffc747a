// What the tab RViz shows: the fixed frame and the displays, which outlive a change of tabs.

import { ShownCamera } from "./camera.js";
import { ShownPicture } from "./image.js";
import { ShownInteractive } from "./interactive.js";
import { Shown } from "./shown.js";

const KINDS = { // that show more than parts in the view
  "rviz/Camera": ShownCamera, "rviz/Image": ShownPicture,
  "rviz/InteractiveMarkers": ShownInteractive,
};
const LIKELY = ["map", "odom", "world"]; // fixed frames, where the person has chosen none
const FIXED = "<Fixed Frame>";
const WORST = ["ok", "warning", "error"];

export class Session {
  constructor(config, types) {
    this.types = new Map(types.map((kind) => [kind.class, kind]));
    this.fixed = config.fixed_frame;
    this.topics = config.topics;
    this.view = config.view;
    this.background = config.background;
    this.target = config.view.frame === FIXED ? "" : config.view.frame ?? ""; // of the camera
    this.displays = [];
    this._next = 1;
    config.displays.forEach((display) => this._add(display));
  }

  /** A display of a class, with its defaults; the new one. `topics`: names by type. */
  add(name, topics) {
    const kind = this.types.get(name);
    const options = Object.fromEntries(kind.options.map((one) => [one.name, one.default]));
    const display = this._add({ class: name, name: name.split("/")[1], enabled: true,
      topic: kind.topic, options, warnings: [], supported: true, topic_is_default: true });
    this.choose(display, topics);
    return display;
  }

  /** For a display whose topic nobody chose: one that exists. Returns whether it has another now. */
  choose(display, topics) {
    if (!display.topic_is_default) return false;
    const kind = this.types.get(display.class);
    const there = kind.messages.flatMap((type) => topics.get(type) ?? []);
    const last = (name) => name.split("/").pop();
    const found = there.includes(kind.topic) ? kind.topic
      : there.find((name) => last(name) === last(kind.topic)) ?? there[0];
    if (!found || found === display.topic) return false;
    display.topic = found;
    return true;
  }

  _add(display) {
    const made = { ...display, id: this._next++, statuses: [] };
    if (!made.supported) made.statuses = [["Display", "error", "not supported here"]];
    this.displays.push(made);
    return made;
  }

  remove(display) {
    this.stop(display);
    this.displays = this.displays.filter((other) => other !== display);
  }

  /** Show what is enabled in a viewport; `onStatus(display)` for each change. */
  open(link, viewport, pictures, onStatus) {
    Object.assign(this, { _link: link, _viewport: viewport, _pictures: pictures,
      _onStatus: onStatus });
    this.displays.forEach((display) => this.start(display));
    this.follow(this.target, [0, 0, 0]); // the camera stands as seen from there
  }

  close() {
    this._stopFollowing();
    this.displays.forEach((display) => this.stop(display));
  }

  start(display) {
    if (!display.enabled || !display.supported || !this.fixed) return;
    const tell = (statuses, namespaces = []) => {
      display.namespaces = namespaces;
      display.statuses = [...display.warnings.map((text) => ["Option", "warning", text]),
        ...statuses];
      this._onStatus(display);
    };
    const Kind = KINDS[display.class] ?? Shown;
    display.shown = new Kind(display, this._link, this._viewport, tell, this._pictures);
    display.shown.start(this.fixed);
  }

  stop(display) {
    display.shown?.stop();
    display.shown = null;
  }

  /** After a change of topic or of whether it is shown. */
  restart(display) {
    this.stop(display);
    if (display.supported) display.statuses = [];
    this.start(display);
    this._onStatus(display);
  }

  /** The camera goes along with a frame from `last` on, its place in m; "": it stays. */
  follow(target, last) {
    this._stopFollowing?.();
    this.target = target;
    this._stopFollowing = () => {};
    if (!target || !this.fixed) return;
    this._stopFollowing = this._link.watch("rviz_place", { frame: this.fixed, target },
      (place) => {
        if (!Array.isArray(place)) return;
        this._viewport.focus(place, last);
        last = place;
      });
  }

  /** Another fixed frame. */
  fix(frame) {
    const first = !this.fixed;
    this.fixed = frame;
    for (const display of this.displays) {
      if (first) this.start(display);
      else display.shown?.change(frame);
    }
    this.follow(this.target);
  }

  /** The frame that is most likely meant, of `{frame: parent}`; "" if there is none. */
  static likely(frames) {
    const root = Object.keys(frames).find((frame) => !frames[frame]);
    return LIKELY.find((frame) => frame in frames) ?? root ?? "";
  }
}

/** The worst of the statuses, or what says that all is well. */
export function worst(statuses) {
  const rank = ([, level]) => WORST.indexOf(level);
  return statuses.reduce((one, other) => (rank(other) > rank(one) ? other : one), ["", "ok", ""]);
}

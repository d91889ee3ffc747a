// The tab RViz: displays of topics in one fixed frame, from a .rviz file or chosen by hand.

import { element } from "./dom.js";
import { DisplayList } from "./rviz/list.js";
import { Session } from "./rviz/session.js";
import { Tools } from "./rviz/tools.js";
import { Viewport } from "./scene/viewport.js";
import * as THREE from "./vendor/three.module.min.js";

export const title = "RViz";

const OVERVIEW = new THREE.Sphere(new THREE.Vector3(0, 0, 0), 4); // m

let session = null; // of this page, whichever tab is shown
let open = null;

async function begin(link) {
  const [config, types] = await Promise.all([link.call("rviz_config"), link.call("rviz_types")]);
  return new Session(config, types);
}

class Tab {
  constructor(parent, link) {
    this._link = link;
    this._box = element("div", { class: "viewport" });
    this._pictures = element("div", { class: "rviz-pictures" });
    this._side = element("div", { class: "rviz-side" });
    parent.append(element("div", { class: "rviz" }, this._side,
      element("div", { class: "rviz-view" }, this._box, this._pictures)));
    this._onHide = () => (document.hidden ? this._rest() : this._show());
    document.addEventListener("visibilitychange", this._onHide);
    this._begin();
  }

  async _begin() {
    try {
      session ??= await begin(this._link);
      if (this._closed) return;
      this._viewport = new Viewport(this._box, new THREE.Group());
    } catch (error) {
      this._side.append(element("p", { class: "error", text: error.message }));
      return;
    }
    this._viewport.setBackground(session.background.split(";").map((one) => one / 255), false,
      true);
    this._look(session.view);
    this._tools = new Tools(session, this._link, this._viewport);
    this._box.append(this._tools.element);
    if (!document.hidden) this._show();
  }

  close() {
    this._closed = true;
    document.removeEventListener("visibilitychange", this._onHide);
    this._rest();
    this._tools?.close();
    this._viewport?.close();
  }

  _show() {
    if (!this._viewport || this._list) return;
    this._list = new DisplayList(session, this._link);
    this._side.replaceChildren(this._list.element);
    session.open(this._link, this._viewport, this._pictures, (display) => this._list.tell(display));
    window.rviz = { session, viewport: this._viewport }; // for tests and the console
  }

  /** While nobody sees it, nobody need send it. */
  _rest() {
    if (!this._list) return;
    session.close();
    this._list.close();
    this._list = null;
  }

  /** The camera as a .rviz file has it. */
  _look({ class: kind, focus, distance, pitch, yaw, scale, x, y }) {
    if (kind === "rviz/TopDownOrtho" && scale) {
      this._viewport.lookDown(x ?? 0, y ?? 0, this._box.clientHeight / scale);
    } else if (distance) this._viewport.orbit(focus, distance, yaw ?? 0, pitch ?? 0.7);
    else this._viewport.lookAt(OVERVIEW);
  }
}

export function mount(parent, link) {
  open = new Tab(parent, link);
}

export function unmount() {
  open?.close();
  open = null;
}

// The tools above the view: what a click or a drag in it means.

import { element } from "../dom.js";
import { t } from "../language.js";
import * as THREE from "../vendor/three.module.min.js";

const ARROW = [[0, -0.06], [0.7, -0.06], [0.7, -0.18], [1, 0], [0.7, 0.18], [0.7, 0.06], [0, 0.06]];
const GREEN = 0x00dd30;
const TURNED = 0.05; // m: a shorter drag gives no direction

const TOOLS = {
  move: { title: t("Move camera", "移动视角"), free: true },
  measure: { title: t("Measure", "测距"), free: true },
  focus: { title: t("Focus", "聚焦"), free: true },
  initial_pose: { title: "2D Pose Estimate", arrow: true },
  goal: { title: "2D Nav Goal", arrow: true },
  point: { title: "Publish Point" },
};

function flatArrow() {
  const shape = new THREE.Shape(ARROW.map(([x, y]) => new THREE.Vector2(x, y)));
  const made = new THREE.Mesh(new THREE.ShapeGeometry(shape),
    new THREE.MeshBasicMaterial({ color: GREEN, side: THREE.DoubleSide, depthTest: false }));
  made.raycast = () => {};
  made.renderOrder = 10;
  return made;
}

/** Buttons and a line of text; `close()` ends them. */
export class Tools {
  constructor(session, link, viewport) {
    Object.assign(this, { _session: session, _link: link, _viewport: viewport });
    this._say = element("span", { id: "rviz-said", class: "muted" });
    this._buttons = new Map(Object.entries(TOOLS)
      .filter(([, tool]) => tool.free || link.control)
      .map(([name, { title }]) => [name, element("button", {
        id: `rviz-tool-${name}`, text: title, onclick: () => this.take(name) })]));
    this.element = element("div", { class: "row rviz-tools" }, ...this._buttons.values(),
      this._say);
    this._events = { pointerdown: (event) => this._press(event),
      pointermove: (event) => this._drag(event), pointerup: (event) => this._release(event) };
    for (const [name, listener] of Object.entries(this._events)) {
      viewport.canvas.addEventListener(name, listener);
    }
    this.take("move");
  }

  close() {
    this._clear();
    for (const [name, listener] of Object.entries(this._events)) {
      this._viewport.canvas.removeEventListener(name, listener);
    }
  }

  take(name) {
    this._clear();
    this._name = name;
    this._first = null;
    this._viewport.movable = name === "move";
    for (const [other, button] of this._buttons) {
      button.setAttribute("aria-pressed", String(other === name));
    }
    const topic = this._session.topics[name];
    if (!topic) return;
    this._tell(this._link.call("rviz_tool", { tool: name, topic }));
  }

  async _tell(asked) {
    try {
      const answer = await asked;
      if (answer) {
        this._say.textContent = answer.listeners ? t("sent", "已发送")
          : t("sent; nobody listens", "已发送，但没有节点订阅");
      }
    } catch (error) {
      this._say.textContent = error.message;
    }
  }

  _press(event) {
    if (this._name === "move" || event.button) return;
    const tool = TOOLS[this._name];
    const place = this._viewport.pick(event, !tool.arrow);
    if (!place) return;
    if (tool.arrow) {
      this._first = place;
      this._mark = flatArrow();
      this._mark.position.copy(place);
      this._viewport.root.add(this._mark);
      this._viewport.draw();
    } else if (this._name === "measure") this._measure(place);
    else if (this._name === "focus") this._done(() => this._viewport.focus(place.toArray()));
    else this._done(() => this._publish(place, 0));
  }

  _drag(event) {
    if (!this._first || !TOOLS[this._name].arrow) return;
    this._mark.rotation.z = this._yaw(event);
    this._viewport.draw();
  }

  _release(event) {
    if (!this._first || !TOOLS[this._name].arrow) return;
    const [place, yaw] = [this._first, this._yaw(event)];
    this._done(() => this._publish(place, yaw));
  }

  _yaw(event) {
    const there = this._viewport.pick(event, false);
    const gap = there?.sub(this._first);
    return gap && gap.length() > TURNED ? Math.atan2(gap.y, gap.x) : this._mark.rotation.z;
  }

  _publish({ x, y, z }, yaw) {
    const tool = this._name;
    this._tell(this._link.call("rviz_publish", { tool, topic: this._session.topics[tool],
      frame: this._session.fixed, x, y, z, yaw }));
  }

  _measure(place) {
    if (!this._first) {
      this._clear();
      this._first = place;
      this._say.textContent = t("now the other end", "请点击另一端");
      return;
    }
    const ends = new THREE.BufferGeometry().setFromPoints([this._first, place]);
    this._mark = new THREE.Line(ends, new THREE.LineBasicMaterial({ color: GREEN,
      depthTest: false }));
    this._mark.raycast = () => {};
    this._mark.renderOrder = 10;
    this._viewport.root.add(this._mark);
    this._viewport.draw();
    this._say.textContent = `${this._first.distanceTo(place).toFixed(3)} m`;
    this._first = null;
  }

  /** The tool has done its work: from now on the camera is moved again. */
  _done(work) {
    work();
    this.take("move");
  }

  _clear() {
    this._mark?.removeFromParent();
    this._mark?.geometry.dispose();
    this._mark?.material.dispose();
    this._mark = null;
    this._viewport.draw();
  }
}

// The tab 3D: world and robots as they are now.

import { element } from "./dom.js";
import { t } from "./language.js";
import { GroundShadows } from "./scene/ground_shadows.js";
import { Links } from "./scene/links.js";
import { Viewport } from "./scene/viewport.js";
import * as THREE from "./vendor/three.module.min.js";

export const title = "3D";

const LARGEST = 25; // m: larger surfaces are ground, and not what an overview is to show
const CLOSE = 2.2; // how much larger than the robot the part of the world is that is shown

const LOADING = t("loading …", "正在加载……");
const NOTHING = t(
  "Nothing to show yet: start a world, such as `roslaunch learning_topic 0course.launch`, " +
  "or a robot with robot_description and tf.",
  "还没有可显示的内容：请启动一个世界，例如 `roslaunch learning_topic 0course.launch`，" +
  "或带有 robot_description 和 tf 的机器人。");

let open = null;

const ROBOTS_LINK = /base_(link|footprint)|wheel|chassis/; // as robots' links are called everywhere

/** The model that is most likely the robot: with links of a robot's names; then of most links. */
export function robotOf(links) {
  const weight = (groups) => groups.length +
    (groups.some((group) => ROBOTS_LINK.test(group.name.split("::").pop())) ? 1e6 : 0);
  let best = null;
  for (const [name, groups] of links.models) {
    if (!best || weight(groups) > weight(links.models.get(best))) best = name;
  }
  return best;
}

function roomy(ball, factor) {
  if (ball) ball.radius *= factor;
  return ball;
}

class Tab {
  constructor(parent, link) {
    this._box = element("div", { class: "viewport" });
    this._hint = element("p", { class: "hint", text: LOADING });
    this._follow = element("select", { title: t("follow a model", "跟随模型"),
      onchange: () => this._startFollowing() });
    const button = (english, chinese, look) => element("button",
      { text: t(english, chinese), onclick: look });
    parent.append(this._box);
    this._box.append(element("div", { class: "row views" }, this._follow,
      button("Robot", "机器人", () => this._lookAtRobot()),
      button("Overview", "全景", () => this._overview(false)),
      button("From above", "俯视", () => this._overview(true))), this._hint);
    this._links = new Links(() => this._look(), link.address);
    this._shadows = new GroundShadows();
    try {
      this._viewport = new Viewport(this._box,
        new THREE.Group().add(this._links.root, this._shadows.root,
          ...(link.overlay ? [link.overlay.root] : [])));
    } catch (error) {
      this._hint.textContent = t("This browser has no WebGL: ", "此浏览器没有 WebGL：") + error.message;
      return;
    }
    this._link = link;
    this._onHide = () => (document.hidden ? this._rest() : this._watch());
    document.addEventListener("visibilitychange", this._onHide);
    if (!document.hidden) this._watch();
  }

  close() {
    document.removeEventListener("visibilitychange", this._onHide);
    this._rest();
    this._shadows.close();
    this._viewport?.close();
  }

  _watch() {
    this._stops ??= [
      this._link.watch("scene", {}, (scene) => this._show(scene)),
      this._link.watch("poses", {}, (data) => this._move(data)),
    ];
  }

  /** While nobody sees it, nobody need send it. */
  _rest() {
    this._stops?.forEach((stop) => stop());
    this._stops = null;
  }

  _show(scene) {
    this._hint.textContent = scene.links.length ? LOADING : NOTHING;
    this._hint.hidden = false; // until something is drawn
    const ground = !scene.links.length || scene.links.some((link) => link.plane !== null);
    this._viewport.setBackground(scene.background, scene.sky, ground);
    this._links.show(scene);
    const names = [...this._links.models.keys()];
    const chosen = this._follow.value;
    this._follow.replaceChildren(
      element("option", { value: "", text: t("follow nothing", "不跟随") }),
      ...names.map((name) => element("option", { value: name, text: name })));
    const wished = this._chosen ? chosen : robotOf(this._links);
    this._follow.value = names.includes(wished) ? wished : "";
    this._followed = null;
    this._placed = false; // poses may put things elsewhere than the scene did
  }

  _move(data) {
    if (!(data instanceof DataView)) {
      this._links.name(data.names);
      return;
    }
    this._links.move(new Float32Array(data.buffer, data.byteOffset, data.byteLength / 4));
    this._shadows.follow();
    this._viewport.draw();
    if (!this._placed && data.byteLength) {
      this._placed = true;
      this._look();
    }
    const place = this._follow.value && this._place();
    if (place && this._followed) this._viewport.shift(place.clone().sub(this._followed));
    this._followed = place || null;
  }

  /** Models or meshes are new; until the person turns the view, it shows the robot. */
  _look() {
    if (!this._viewport) return;
    this._hint.hidden ||= this._links.bounds(null) !== null;
    this._shadows.show(this._links);
    if (!this._viewport.touched) this._lookAtRobot();
    this._viewport.draw();
  }

  _startFollowing() {
    this._chosen = true;
    this._followed = this._place();
    const ball = this._follow.value && roomy(this._links.bounds(this._follow.value), CLOSE);
    this._viewport.touched = true;
    if (ball) this._viewport.lookAt(ball);
  }

  _place() {
    return this._links.models.get(this._follow.value)?.[0].position.clone() ?? null;
  }

  _lookAtRobot() {
    const ball = roomy(this._links.bounds(robotOf(this._links)), CLOSE);
    if (ball) this._viewport.lookAt(ball);
  }

  _overview(down) {
    this._viewport.touched = this._chosen = true;
    this._follow.value = "";
    const ball = this._links.bounds(null, LARGEST);
    if (ball) this._viewport.lookAt(ball, down);
  }
}

export function mount(parent, link) {
  open = new Tab(parent, link);
}

export function unmount() {
  open?.close();
  open = null;
}

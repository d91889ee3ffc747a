// Driving: keys, a joystick for fingers, and sliders for the speeds, beside a view of the robot.

import { element } from "./dom.js";
import { Handle } from "./drive/handle.js";
import { joystick } from "./drive/joystick.js";
import { listenToKeys } from "./drive/keys.js";
import { t } from "./language.js";

export const title = t("Drive", "驾驶");

const VIEWS = { "./scene.js": t("3D view", "三维视图"), "./images.js": t("camera", "相机") };
const LOOK_AGAIN_MS = 2000; // for robots that come later
const CAR = "ackermann_msgs/AckermannDriveStamped";
const SPEED = { start: 0.2, most: 2 }; // m/s
const TURN = { start: 1, most: 3 }; // rad/s
const STEER = { start: 0.3, most: 0.6 }; // rad, of a car's front wheels
const REASONS = {
  space: t("Stopped.", "已停止。"),
  blur: t("Stopped: this window lost the keyboard.", "已停止：窗口失去了键盘焦点。"),
  hidden: t("Stopped: this tab was hidden.", "已停止：标签页被隐藏。"),
  closed: t("Stopped.", "已停止。"),
  slow: t("Stopped: this browser draws too slowly to tell when a finger comes up. Use the keys, " +
    "or the camera as view.", "已停止：浏览器绘图太慢，无法及时得知手指抬起。请用按键，或把视图换成相机。"),
  hung: t("Stopped: this page hung for a moment. Press again.", "已停止：页面卡顿了一下，请重新按键。"),
  connection: t("Stopped: the connection was lost.", "已停止：连接断开。"),
};

let endings = [];

/** A slider with its name and value; `value()` reads it. */
function slider(id, name, unit, { start, most }) {
  const shown = element("output");
  const input = element("input", {
    type: "range", id, min: 0.02, max: most, step: 0.02, value: start,
    oninput: () => (shown.textContent = `${Number(input.value).toFixed(2)} ${unit}`),
    onchange: () => input.blur(), // or it would take the arrow keys
  });
  input.dispatchEvent(new Event("input"));
  const label = element("label", {}, element("span", { text: name }), shown, input);
  return { label, value: () => Number(input.value) };
}

/** A select that shows one of the other tabs' views in `place`. */
function viewChoice(place, link) {
  let shown = null;
  const show = async (path) => {
    shown?.unmount?.();
    shown = null;
    place.replaceChildren();
    try {
      shown = await import(path);
      shown.mount(place, link);
    } catch (error) {
      place.textContent = error.message;
    }
  };
  const select = element("select", { id: "drive-view", onchange: () => show(select.value) },
    ...Object.entries(VIEWS).map(([value, text]) => element("option", { value, text })));
  show(select.value);
  endings.push(() => shown?.unmount?.());
  return select;
}

/** A select of the topics that robots listen to; `open(topic, type)` for the one that is chosen. */
function topicChoice(link, open) {
  const types = new Map();
  const choose = () => open(select.value, types.get(select.value));
  const select = element("select", { id: "drive-topic", onchange: choose });
  let shown = "";
  const fill = async () => {
    if (document.hidden) return;
    const found = await link.call("drive_topics");
    found.forEach(({ topic, type }) => types.set(topic, type));
    const before = select.value;
    // A robot that disappears for a moment is not replaced by another while somebody drives.
    const gone = before && !found.some(({ topic }) => topic === before);
    const topics = [...(gone ? [before] : []), ...found.map(({ topic }) => topic)];
    if (String(topics) === shown) return;
    shown = String(topics);
    const chosen = before || "/cmd_vel";
    select.replaceChildren(...topics.map((topic) =>
      element("option", { value: topic, text: topic, selected: topic === chosen })));
    if (select.value !== before) choose();
  };
  const look = () => fill().catch(() => {}); // again, when the server is back
  const timer = setInterval(look, LOOK_AGAIN_MS);
  endings.push(() => clearInterval(timer));
  look();
  return select;
}

export function mount(place, link) {
  const view = element("div", { class: "drive-view" });
  const panel = element("div", { class: "drive-panel" });
  place.append(element("div", { class: "drive" }, view, panel));
  panel.append(element("label", { text: t("View", "视图") }, viewChoice(view, link)));
  if (link.control) controls(panel, link);
  else panel.append(element("p", { id: "drive-state", text: t(
    "This page may only look. Start it with control:=true to drive.",
    "本页只能查看。用 control:=true 启动后才能驾驶。") }));
}

function controls(panel, link) {
  const state = element("p", { id: "drive-state" });
  const drivers = element("p", { id: "drive-who", class: "muted" });
  const speed = slider("drive-speed", t("speed", "速度"), "m/s", SPEED);
  const turn = slider("drive-turn", t("turning", "转向"), "rad/s", TURN);
  const steer = slider("drive-steer", t("steering angle", "转向角"), "rad", STEER);
  let topic = null;
  let car = false;
  let wiring = [];

  const say = (name, reason) => {
    state.dataset.state = name;
    state.textContent = name === "driving" ? t("Driving.", "行驶中。")
      : name === "stopped" ? REASONS[reason] ?? reason
        : t("Hold W A S D or the arrow keys, or the joystick. Space stops.",
          "按住 W A S D、方向键或摇杆行驶，空格键停止。");
  };
  const tellDrivers = () => {
    const nodes = wiring.find(({ name }) => name === topic)?.from ?? [];
    drivers.textContent = nodes.length ? t(`${nodes.join(", ")} sends commands here, too`,
      `${nodes.join(", ")} 也在这里发送指令`) : "";
  };
  const open = async (name, type) => {
    handle.drop("closed");
    topic = name; // at once: a key that is pressed now is meant for the robot that is shown
    tellDrivers();
    car = type === CAR;
    turn.label.hidden = car;
    steer.label.hidden = !car;
    try {
      await link.call("drive_open", { topic });
    } catch (error) {
      if (topic === name) say("stopped", error.message);
    }
  };
  const handle = new Handle(link, (forward, side) => ({
    linear: forward * speed.value(), angular: side * (car ? steer : turn).value(),
    ...(topic && { topic }),
  }), say);
  steer.label.hidden = true;
  endings.push(listenToKeys(handle));
  endings.push(link.watch("wiring", {}, ({ rows = [] }) => {
    wiring = rows;
    tellDrivers();
  }));
  endings.push(link.onConnection((there) => there || handle.drop("connection")));
  panel.append(element("label", { text: t("Topic", "话题") }, topicChoice(link, open)), drivers,
    speed.label, turn.label, steer.label, joystick(handle), state);
  say("idle");
}

export function unmount() {
  endings.forEach((end) => end());
  endings = [];
}

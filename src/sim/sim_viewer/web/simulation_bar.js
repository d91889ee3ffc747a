// Simulated time, real-time factor, the buttons that pause, step and reset, and what is amiss.

import { element } from "./dom.js";
import { t } from "./language.js";

const FACTOR_DIGITS = 2;

/** `digits` behind the point: while paused, a step of 1 ms must show. */
function clock(time, digits) {
  const scale = 10 ** digits;
  const whole = Math.round(time * scale) / scale; // or 59.96 s would be 0:60.0
  const minutes = Math.floor(whole / 60);
  return `${minutes}:${(whole - 60 * minutes).toFixed(digits).padStart(digits + 3, "0")}`;
}

/** Fill `bar`; it follows the watch `status` as long as the page is open. */
export function simulationBar(bar, link) {
  const time = element("span", { id: "time", title: t("simulated time", "仿真时间") });
  const factor = element("span", { id: "factor", title: t("real-time factor", "实时系数") });
  const problem = element("span", { id: "problem", class: "error" });
  bar.append(problem, time, factor);
  let paused = false;
  let lost = false; // the ROS master
  const say = (short, whole = "") => {
    problem.textContent = short;
    problem.title = whole;
  };
  const ask = (op, args) => link.call(op, args).then(() => say(""),
    (error) => say(t("failed", "失败"), error.message));
  link.onConnection((there, reason) => {
    lost = false;
    say(there ? "" : reason || t("the server is gone", "服务器已断开"));
  });
  const button = (id, text, title, onclick) => element("button", { id, text, title, onclick });
  const pause = button("pause", "❚❚", t("pause", "暂停"), () => ask("pause", { paused: !paused }));
  const step = button("step", "▶❚", t("one step", "单步"), () => ask("step", { steps: 1 }));
  const reset = button("reset", "⟲", t("models back to their start", "模型回到起点"),
    () => ask("reset", { what: "world" }));
  if (link.control) bar.append(pause, step, reset);
  link.watch("status", {}, (status) => {
    if (Boolean(status.error) !== lost) {
      lost = Boolean(status.error);
      say(lost ? t("no ROS master", "没有 ROS master") : "", status.error);
    }
    time.textContent = status.time == null ? "" : clock(status.time, status.paused ? 3 : 1);
    factor.textContent = status.factor == null ? "" : `× ${status.factor.toFixed(FACTOR_DIGITS)}`;
    paused = Boolean(status.paused);
    pause.textContent = paused ? "▶" : "❚❚";
    for (const one of [pause, step, reset]) one.disabled = !status.simulator;
    bar.classList.toggle("paused", paused);
  });
}

// Simulated time, real-time factor, and the buttons that pause, step and reset.

import { element } from "./dom.js";
import { t } from "./language.js";

const FACTOR_DIGITS = 2;

function clock(time) {
  const minutes = Math.floor(time / 60);
  return `${minutes}:${(time % 60).toFixed(1).padStart(4, "0")}`;
}

/** Fill `bar`; it follows the watch `status` as long as the page is open. */
export function simulationBar(bar, link) {
  const time = element("span", { id: "time", title: t("simulated time", "仿真时间") });
  const factor = element("span", { id: "factor", title: t("real-time factor", "实时系数") });
  bar.append(time, factor);
  let paused = false;
  const ask = (op, args) => link.call(op, args).catch((error) => (factor.title = error.message));
  const button = (id, text, title, onclick) => element("button", { id, text, title, onclick });
  const pause = button("pause", "❚❚", t("pause", "暂停"), () => ask("pause", { paused: !paused }));
  const step = button("step", "▶❚", t("one step", "单步"), () => ask("step", { steps: 1 }));
  const reset = button("reset", "⟲", t("models back to their start", "模型回到起点"),
    () => ask("reset", { what: "world" }));
  if (link.control) bar.append(pause, step, reset);
  link.watch("status", {}, (status) => {
    time.textContent = status.time == null ? "" : clock(status.time);
    factor.textContent = status.factor == null ? "" : `× ${status.factor.toFixed(FACTOR_DIGITS)}`;
    paused = Boolean(status.paused);
    pause.textContent = paused ? "▶" : "❚❚";
    for (const one of [pause, step, reset]) one.disabled = !status.simulator;
    bar.classList.toggle("paused", paused);
  });
}

// A slider over a run's time with its marks: of the live page, and of run.html.

import { element } from "../dom.js";
import { t } from "../language.js";

const PLACES = 300; // marks that are nearer to each other are one
const MOST_NAMED = 5; // in one's tooltip
const NAMES = { __proto__: null, // a mark may have any name
  lost: t("line lost", "偏离赛道"), contact: t("contact", "碰撞"), lap: t("lap", "完成一圈"),
  largest: t("largest error", "最大偏差"),
};

/** `[name, time, text]` in words, with its time. */
function words([name, time, text]) {
  return `${NAMES[name] ?? name}${text ? ` (${text})` : ""}, ${time.toFixed(2)} s`;
}

export class TimeBar {
  /** `choose(time)`: the person has chosen a moment, s; `drag(time)`: it passes while dragging. */
  constructor(id, choose, drag = choose) {
    const value = () => Number(this.slider.value);
    this.slider = element("input", { type: "range", id, step: 0.001, min: 0, max: 1, value: 0,
      title: t("simulated time", "仿真时间"),
      oninput: () => drag(value()), onchange: () => choose(value()) });
    this._choose = choose;
    this._marks = element("div", { class: "marks" });
    this.box = element("div", { class: "time-bar" }, this.slider, this._marks);
  }

  /** `marks`: `[name, time, text]` of each. */
  range(first, last, marks) {
    this.slider.min = first;
    this.slider.max = Math.max(last, first + 1e-3);
    const places = new Map();
    for (const mark of marks) {
      const share = Math.min(1, Math.max(0, (mark[1] - first) / (this.slider.max - first)));
      const place = Math.round(share * PLACES) / PLACES;
      places.set(place, [...(places.get(place) ?? []), mark]);
    }
    this._marks.replaceChildren(...[...places].map(([place, there]) => {
      const title = there.slice(0, MOST_NAMED).map(words).join("\n") +
        (there.length > MOST_NAMED ? `\n+ ${there.length - MOST_NAMED}` : "");
      return element("button", { class: `mark ${there.at(-1)[0] in NAMES ? there.at(-1)[0] : ""}`,
        style: `left: ${100 * place}%`, title, "aria-label": title,
        onclick: () => this._choose(there[0][1]) });
    }));
  }

  show(time) {
    this.slider.value = time;
  }
}

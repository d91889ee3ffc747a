// A second run.html, chosen from disk, to be laid over this one.

import { element } from "../dom.js";
import { t } from "../language.js";
import { Motion } from "./motion.js";
import { COLOURS } from "./overlay.js";

/** The data in the text of a run.html; an Error if it has none. */
export function runIn(text) {
  const found = new DOMParser().parseFromString(text, "text/html").getElementById("run");
  const run = JSON.parse(found?.textContent ?? "");
  if (!run.times?.length || !run.poses || !run.scene?.links) throw new Error("no run");
  return run;
}

/** A row with the choice of a file and, once there is one, both runs' names in their colours;
 * `take(motion)` is called with the other's, and with null when it is put away. */
export function comparison(title, take) {
  const legend = element("span", { class: "legend" });
  const file = element("input", { type: "file", id: "other", accept: ".html", hidden: true,
    onchange: () => file.files[0] && read(file.files[0]) });
  const box = element("div", { class: "row compare" }, element("button", { id: "compare",
    text: t("Lay another run.html over this one", "叠加另一个 run.html"),
    onclick: () => file.click() }), file, legend);
  const named = (text, colour) => element("span", {},
    element("span", { style: `color: ${colour}`, text: "■ " }), text);

  async function read(chosen) {
    legend.replaceChildren();
    try {
      const run = runIn(await chosen.text());
      take(new Motion(run));
      legend.append(named(title, COLOURS[0]), named(run.title, COLOURS[1]),
        element("button", { id: "alone", text: "×", title: t("this run alone", "只看这一次"),
          onclick: () => { legend.replaceChildren(); take(null); } }));
    } catch {
      take(null);
      legend.append(element("span", { class: "error",
        text: t(`${chosen.name} is no run.html of a run`, `${chosen.name} 不是一次运行的 run.html`) }));
    }
    file.value = "";
  }
  return box;
}

/** The other's curve minus this one's, at this one's times up to the other's end. */
export function difference(curve, other) {
  const times = curve.times.filter((time) => other.times[0] <= time && time <= other.times.at(-1));
  return { name: [`difference, ${curve.name[0]}`, `之差：${curve.name[1]}`], unit: curve.unit, times,
    values: times.map((time, i) => {
      let next = other.times.findIndex((one) => one >= time);
      const before = Math.max(next - 1, 0);
      const span = other.times[next] - other.times[before];
      const share = span > 0 ? (time - other.times[before]) / span : 0;
      return other.values[before] + share * (other.values[next] - other.values[before])
        - curve.values[i];
    }) };
}

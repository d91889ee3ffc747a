// A curve over time, with a mark at the moment that is shown; a click chooses another.

import { element } from "../dom.js";
import { COLOURS } from "./overlay.js";

const [WIDTH, HEIGHT, EDGE] = [600, 120, 6]; // px

function drawn(tag, properties) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(properties)) made.setAttribute(name, value);
  return made;
}

/** The value at a time; the last one behind the end. */
function valueAt({ times, values }, time) {
  return values.at(times.findIndex((one) => one >= time));
}

/** `box` and `mark(time)`; the curve's name in `language`. `other`: the same of another run. */
export function plot(curve, language, first, last, choose, other = null) {
  const shown = other ? [curve, other] : [curve];
  const low = Math.min(0, ...shown.flatMap(({ values }) => values));
  const high = Math.max(low + 1e-3, ...shown.flatMap(({ values }) => values));
  const x = (time) => (time - first) / (last - first) * WIDTH;
  const y = (value) => HEIGHT - EDGE - (value - low) / (high - low) * (HEIGHT - 2 * EDGE);
  const svg = drawn("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  const now = drawn("line", { y1: 0, y2: HEIGHT, class: "now" });
  svg.append(drawn("line", { x1: 0, x2: WIDTH, y1: y(0), y2: y(0), class: "zero" }),
    ...shown.map(({ times, values }, which) => drawn("polyline", {
      points: times.map((time, i) => `${x(time).toFixed(1)},${y(values[i]).toFixed(1)}`).join(" "),
      ...(other && { style: `stroke: ${COLOURS[which]}` }) })), now);
  svg.addEventListener("click", (event) => choose(
    first + event.offsetX / svg.clientWidth * (last - first)));
  const value = element("span", { class: "mono" });
  const name = curve.name[language === "zh" ? 1 : 0];
  const range = `${low.toFixed(2)} … ${high.toFixed(2)} ${curve.unit}`;
  const box = element("figure", { class: "card" },
    element("figcaption", {}, `${name}: `, value, element("span", { class: "muted", text: range })),
    svg);
  return {
    box,
    mark(time) {
      now.setAttribute("x1", x(time));
      now.setAttribute("x2", x(time));
      const values = shown.map((one) => valueAt(one, time).toFixed(2)).join(" | ");
      value.textContent = `${values} ${curve.unit} `;
    },
  };
}

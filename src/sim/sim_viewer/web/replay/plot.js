// A curve over time, with a mark at the moment that is shown; a click chooses another.

import { element } from "../dom.js";

const [WIDTH, HEIGHT, EDGE] = [600, 120, 6]; // px

function drawn(tag, properties) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(properties)) made.setAttribute(name, value);
  return made;
}

/** `box` and `mark(time)`; the curve's name in `language`. */
export function plot(curve, language, first, last, choose) {
  const low = Math.min(0, ...curve.values);
  const high = Math.max(low + 1e-3, ...curve.values);
  const x = (time) => (time - first) / (last - first) * WIDTH;
  const y = (value) => HEIGHT - EDGE - (value - low) / (high - low) * (HEIGHT - 2 * EDGE);
  const svg = drawn("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
  const line = curve.times.map((time, i) => `${x(time).toFixed(1)},${y(curve.values[i]).toFixed(1)}`);
  const now = drawn("line", { y1: 0, y2: HEIGHT, class: "now" });
  svg.append(drawn("line", { x1: 0, x2: WIDTH, y1: y(0), y2: y(0), class: "zero" }),
    drawn("polyline", { points: line.join(" ") }), now);
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
      const at = curve.times.findIndex((one) => one >= time);
      value.textContent = `${curve.values.at(at).toFixed(2)} ${curve.unit} `;
    },
  };
}

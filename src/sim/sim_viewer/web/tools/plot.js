// Any numeric field of any topic over time.

import { element } from "../dom.js";
import { t } from "../language.js";
import { checkbox, choice, errorLine, toldError, workButton } from "./parts.js";
import { Chart } from "./chart.js";
import { Series, csv } from "./series.js";

export const title = t("Plot", "曲线");

const COLOURS = ["#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2",
  "#7f7f7f", "#bcbd22", "#17becf"];
const SPANS = [5, 10, 30, 60, 300]; // s
const kept = { lines: [], span: 30, paused: false }; // stays when another tab is shown
let stops = [];

/** The colour that fewest lines have. */
function nextColour() {
  const used = (colour) => kept.lines.filter((line) => line.colour === colour).length;
  return COLOURS.reduce((best, colour) => (used(colour) < used(best) ? colour : best));
}

function shortNumber(value) {
  if (value === undefined || value === null) return "–";
  return Math.abs(value) >= 1e5 || (value && Math.abs(value) < 1e-3)
    ? value.toExponential(3) : String(Number(value.toPrecision(5)));
}

export function mount(place, link) {
  const problem = errorLine();
  const chart = new Chart(() => kept);
  const legend = element("div", { class: "legend", id: "plot-legend" });
  const watches = new Map(); // path -> stop
  const offered = element("datalist", { id: "plot-paths" });
  const path = element("input", {
    id: "plot-path", list: "plot-paths", placeholder: "/odom/pose/pose/position/x",
    autocapitalize: "off", spellcheck: "false", oninput: offerFields,
    onkeydown: (event) => event.key === "Enter" && add.click(),
  });
  let topics = [];

  async function offerFields() {
    const topic = topics.find((name) => path.value === name || path.value === `${name}/`);
    if (!topic) return;
    const fields = await link.call("plot_fields", { topic }).catch(() => []);
    offered.replaceChildren(...[...fields, ...topics].map((value) => element("option", { value })));
  }

  function watch(line) {
    watches.set(line.path, link.watch("plot", { paths: [line.path] }, (data) => {
      if (toldError(data, problem) || kept.paused) return;
      line.series.add(data[line.path] ?? []);
      line.shown.textContent = shortNumber(line.series.last());
      chart.draw();
    }, problem.show));
  }

  function remove(line) {
    watches.get(line.path)?.();
    watches.delete(line.path);
    kept.lines = kept.lines.filter((one) => one !== line);
    line.entry.remove();
    chart.draw();
  }

  function show(line) {
    line.shown = element("output", { text: shortNumber(line.series.last()) });
    const colour = element("span", { class: "swatch" });
    colour.style.background = line.colour;
    line.entry = element("div", { class: "entry", "data-path": line.path }, colour,
      checkbox("", line.path, line.visible, (visible) => {
        line.visible = visible;
        chart.draw();
      }), line.shown,
      element("button", { text: "✕", title: t("remove", "移除"), onclick: () => remove(line) }));
    legend.append(line.entry);
    watch(line);
  }

  const add = workButton("plot-add", t("add", "添加"), problem, async () => {
    const wanted = path.value.trim();
    if (!wanted) return;
    for (const one of await link.call("plot_expand", { path: wanted })) {
      if (kept.lines.some((line) => line.path === one)) continue;
      const line = { path: one, colour: nextColour(), visible: true, series: new Series() };
      kept.lines.push(line);
      show(line);
    }
    path.value = "";
    chart.draw();
  }, "primary");

  const pause = element("button", { id: "plot-pause", onclick: () => setPaused(!kept.paused) });
  function setPaused(paused) {
    kept.paused = paused;
    pause.textContent = paused ? t("go on", "继续") : t("hold", "停住");
  }
  setPaused(kept.paused);

  const save = element("button", {
    text: "CSV", title: t("save what is shown", "保存所示数据"), onclick: () => {
      const file = new Blob([csv(kept.lines)], { type: "text/csv" });
      const anchor = element("a", { href: URL.createObjectURL(file), download: "plot.csv" });
      anchor.click();
      setTimeout(() => URL.revokeObjectURL(anchor.href), 1000);
    },
  });
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" }, path, offered, add,
      choice("plot-span", SPANS.map((span) => [span, `${span} s`]), kept.span, (span) => {
        kept.span = Number(span);
        chart.draw();
      }), pause,
      element("button", {
        text: t("clear", "清空"), onclick: () => {
          kept.lines.forEach((line) => line.series.clear());
          chart.draw();
        },
      }), save),
    problem, legend, element("div", { class: "drawing" }, chart.canvas, chart.readout),
    kept.lines.length ? "" : element("p", { class: "muted", text: t(
      "A topic offers its numbers; /turtle1/pose/x:y is two lines, /scan/ranges[0] one element.",
      "输入话题名即可选择其数值；/turtle1/pose/x:y 是两条曲线，/scan/ranges[0] 是一个元素。") })));
  kept.lines.forEach(show);
  chart.start();
  stops = [
    () => chart.stop(),
    () => watches.forEach((stop) => stop()),
    link.watch("topics", {}, (rows) => {
      if (!Array.isArray(rows)) return;
      topics = rows.map((row) => row.name);
      offered.replaceChildren(...topics.map((value) => element("option", { value })));
    }, problem.show),
  ];
}

export function unmount() {
  stops.forEach((stop) => stop());
  stops = [];
}

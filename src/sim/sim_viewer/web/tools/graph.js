// Nodes and topics, and what flows between them.

import { element } from "../dom.js";
import { t } from "../language.js";
import { drawGraph } from "./graph_drawing.js";
import { panAndZoom } from "./pan_zoom.js";
import { checkbox, choice, errorLine, toldError } from "./parts.js";
import { showWiring } from "./wiring.js";

export const title = t("Graph", "节点图");

const TYPING_MS = 300;
const VIEWS = [
  ["active", t("nodes and topics", "节点与话题")],
  ["all", t("all topics", "全部话题")],
  ["nodes", t("nodes only", "仅节点")],
];
const settings = { view: "active", quiet: true, text: "" };
let stop = null;
let stopWiring = null;

export function mount(place, link) {
  const problem = errorLine();
  const box = element("div", { class: "drawing", id: "graph" });
  const facts = element("p", { class: "muted", id: "graph-facts" });
  const view = panAndZoom(box);
  let shape = "";

  const show = (graph) => {
    if (toldError(graph, problem)) return;
    const { svg, size, describe } = drawGraph(graph, (text) => (facts.textContent = text));
    view.show(svg, size, shape === ""); // keeps the place on later changes
    shape = "shown";
    facts.textContent = describe;
  };
  const watch = () => {
    stop?.();
    shape = "";
    stop = link.watch("graph", { ...settings }, show, problem.show);
  };
  const set = (name) => (value) => {
    settings[name] = value;
    watch();
  };
  let timer = null;
  const filter = element("input", {
    type: "search", id: "graph-filter", placeholder: t("part of a name", "名称的一部分"),
    value: settings.text,
    oninput: () => {
      clearTimeout(timer);
      timer = setTimeout(() => set("text")(filter.value.trim()), TYPING_MS);
    },
  });
  const wiring = element("div");
  place.append(element("div", { class: "pad tool" }, wiring,
    element("div", { class: "row" },
      choice("graph-view", VIEWS, settings.view, set("view")),
      filter,
      checkbox("graph-quiet", t("hide /rosout, /clock, this page", "隐藏 /rosout、/clock 和本页"),
        settings.quiet, set("quiet")),
      element("button", { text: t("whole", "全图"), onclick: () => view.fit() })),
    problem, facts, box));
  stopWiring = showWiring(wiring, link, problem.show);
  watch();
}

export function unmount() {
  stop?.();
  stopWiring?.();
  stop = stopWiring = null;
}

// The list of topics: types, who is at both ends, how often, and what comes.

import { element } from "../dom.js";
import { t } from "../language.js";
import { FilteredTable } from "./filtered_table.js";
import { bytes, checkbox, errorLine, reveal, toldError, writeName } from "./parts.js";

export const title = t("Topics", "话题");

const ALL_ELEMENTS = 5000; // of arrays, where all are asked for
let stops = [];

/** The echo of one topic in `place`; the result ends it. */
function echo(place, row, link) {
  const problem = errorLine();
  const text = element("pre", { id: "echo", class: "card" });
  const facts = element("p", { class: "muted" });
  let stop = null;
  const watch = (all) => {
    stop?.();
    text.textContent = t("nothing has come yet", "尚无消息");
    stop = link.watch("echo", { topic: row.name, ...(all ? { elements: ALL_ELEMENTS } : {}) },
      (data) => {
        if (toldError(data, problem)) return;
        text.textContent = data.text;
        facts.textContent = t(`message ${data.count}, from ${data.publisher}`,
          `第 ${data.count} 条消息，来自 ${data.publisher}`);
      }, problem.show);
  };
  const ends = (name, nodes) => element("p", {}, element("span", { class: "muted", text: name }),
    ` ${nodes.join(", ") || "–"}`);
  place.replaceChildren(
    element("h3", { class: "mono", text: row.name }),
    element("p", { class: "mono", text: row.type }),
    ends(t("publishers:", "发布者："), row.publishers),
    ends(t("subscribers:", "订阅者："), row.subscribers),
    checkbox("echo-all", t("long arrays in full", "完整显示长数组"), false, watch),
    problem, facts, text);
  watch(false);
  return () => stop();
}

export function mount(place, link) {
  const problem = errorLine();
  const detail = element("div", { class: "detail", id: "topic-detail" },
    element("p", { class: "muted", text: t("Choose a topic to see its messages.",
      "选择一个话题查看其消息。") }));
  const rates = new Map(); // topic -> {stop, shown}
  let stopEcho = null;

  function measure(name, wanted) {
    rates.get(name)?.stop();
    rates.delete(name);
    if (!wanted) return table.update(table.rows.map(withRate));
    const rate = { shown: "…" };
    rates.set(name, rate);
    const show = (text) => {
      rate.shown = text;
      table.update(table.rows.map(withRate));
    };
    rate.stop = link.watch("rate", { topic: name }, (data) => {
      if (!toldError(data, problem)) {
        show(`${data.rate.toFixed(data.rate < 10 ? 2 : 1)} Hz, ${bytes(data.bandwidth)}/s`);
      }
    }, show);
    return show("…");
  }
  const withRate = (row) => ({ ...row, rate: rates.get(row.name)?.shown ?? null });

  function writeRate(cell, row) {
    if (!cell.firstChild) {
      const box = checkbox("", "", false, (wanted) => measure(row.name, wanted));
      box.addEventListener("click", (event) => event.stopPropagation());
      cell.append(box, element("span"));
    }
    cell.querySelector("input").checked = row.rate !== null;
    cell.lastChild.textContent = row.rate ?? "";
  }
  const write = (read) => (cell, row) => (cell.textContent = read(row));
  const table = new FilteredTable({
    id: "topics",
    search: (row) => `${row.name} ${row.type}`,
    columns: [
      { title: t("topic", "话题"), className: "mono", write: (cell, row) => writeName(cell, row.name) },
      { title: t("type", "类型"), className: "mono wide",
        write: (cell, row) => writeName(cell, row.type) },
      { title: t("pub", "发布"), write: write((row) => row.publishers.length) },
      { title: t("sub", "订阅"), write: write((row) => row.subscribers.length) },
      { title: t("rate", "频率"), className: "number rate", write: writeRate },
    ],
    onOpen: (row) => {
      stopEcho?.();
      stopEcho = echo(detail, row, link);
      reveal(detail);
    },
  });
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" }, table.box), problem,
    element("div", { class: "split" }, table.element, detail)));
  const stop = link.watch("topics", {}, (rows) => {
    if (!toldError(rows, problem)) table.update(rows.map(withRate));
  }, problem.show);
  stops = [stop, () => stopEcho?.(), () => rates.forEach((rate) => rate.stop())];
}

export function unmount() {
  stops.forEach((stop) => stop());
  stops = [];
}

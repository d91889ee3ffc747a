// The tree of frames: who publishes each, how often and how old it is.

import { element } from "../dom.js";
import { t } from "../language.js";
import { errorLine, reveal, toldError } from "./parts.js";
import { FilteredTable } from "./filtered_table.js";

export const title = t("TF", "坐标系");

const OLD = 1.0; // s; most frames come at least ten times a second
let stop = null;

// What is no number comes as null.
const three = (values, digits) =>
  values.map((value) => value?.toFixed(digits) ?? "NaN").join(", ");

function problemText(row) {
  if (row.problem === "loop") return t("a loop: no root above", "成环：上方没有根");
  return row.problem ? t(`several ${row.problem}`, `多个父坐标系（${row.problem}）`) : "";
}

function writeFrame(cell, row) {
  const name = element("span", { class: "mono", text: row.frame });
  name.style.paddingLeft = `${row.depth * 1.2}em`;
  cell.replaceChildren(name, element("span", { class: "error", text: ` ${problemText(row)}` }));
}

function writeAge(cell, row) {
  const old = row.age > OLD || row.age < -OLD;
  cell.textContent = row.static ? t("static", "静态")
    : row.parent === null ? "" : `${row.age.toFixed(2)} s`;
  cell.classList.toggle("warn", old);
}

/** One frame's place in its parent. */
function describe(place, row) {
  place.dataset.frame = row.frame;
  if (row.parent === null) {
    place.replaceChildren(element("h3", { class: "mono", text: row.frame }),
      element("p", { class: "muted", text: t("a root: nothing is above it", "根：上方没有坐标系") }));
    return;
  }
  const fact = (name, value) => element("p", {},
    element("span", { class: "muted", text: `${name} ` }),
    element("span", { class: "mono", text: value }));
  place.replaceChildren(
    element("h3", { class: "mono", text: `${row.parent} → ${row.frame}` }),
    fact("x, y, z (m)", three(row.place, 4)),
    fact(t("roll, pitch, yaw (°)", "横滚、俯仰、偏航 (°)"), three(row.angles, 2)),
    fact(t("published by", "发布者"), row.publisher));
}

export function mount(place, link) {
  const problem = errorLine();
  const detail = element("div", { class: "detail", id: "tf-detail" });
  const write = (read) => (cell, row) => (cell.textContent = read(row));
  const table = new FilteredTable({
    id: "tf",
    search: (row) => `${row.frame} ${row.publisher ?? ""}`,
    columns: [
      { title: t("frame", "坐标系"), write: writeFrame },
      { title: t("rate", "频率"), className: "number",
        write: write((row) => (row.rate ? `${row.rate.toFixed(1)} Hz` : "")) },
      { title: t("age", "延迟"), className: "number", write: writeAge },
      { title: t("publisher", "发布者"), className: "mono wide",
        write: write((row) => row.publisher ?? "") },
    ],
    onOpen: (row) => {
      describe(detail, row);
      reveal(detail);
    },
  });
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" }, table.box), problem,
    element("div", { class: "split" }, table.element, detail)));
  stop = link.watch("tf", {}, (rows) => {
    if (toldError(rows, problem)) return;
    const named = rows.map((row) => ({ ...row, name: row.frame }));
    table.update(named);
    const chosen = named.find((row) => row.frame === detail.dataset.frame);
    if (chosen) describe(detail, chosen);
  }, problem.show);
}

export function unmount() {
  stop?.();
  stop = null;
}

// A table with a search box that stays quick with thousands of rows: rows are made once, those
// that changed are written again, and no more are shown than anybody reads.

import { element } from "../dom.js";
import { t } from "../language.js";

const MOST_SHOWN = 300;
const TYPING_MS = 150;

/**
 * `columns` are `{title, write(cell, row), className}`; rows have a `name` of their own.
 * `search(row)` is the text that the box looks in, `onOpen(row)` is called when a row is chosen.
 */
export class FilteredTable {
  constructor({ id, columns, search = (row) => row.name, onOpen = null, keep = () => true }) {
    this.columns = columns;
    this.search = search;
    this.onOpen = onOpen;
    this.keep = keep; // which rows are there at all, such as "no loggers"
    this.rows = [];
    this.chosen = null;
    this.made = new Map(); // name -> {line, cells, written}
    this.box = element("input", {
      type: "search", id: `${id}-search`, placeholder: t("filter", "筛选"), class: "filter",
      oninput: () => {
        clearTimeout(this.timer);
        this.timer = setTimeout(() => this.draw(), TYPING_MS);
      },
    });
    this.body = element("tbody");
    this.more = element("p", { class: "muted" });
    const heads = columns.map(({ title, className = "" }) =>
      element("th", { text: title, class: className }));
    this.table = element("table", { class: "list", id },
      element("thead", {}, element("tr", {}, ...heads)), this.body);
    this.element = element("div", { class: "filtered" }, this.table, this.more);
  }

  update(rows) {
    this.rows = rows;
    const names = new Set(rows.map((row) => row.name));
    for (const name of this.made.keys()) if (!names.has(name)) this.made.delete(name);
    this.draw();
  }

  draw() {
    const wanted = this.box.value.trim().toLowerCase();
    const fitting = this.rows.filter(
      (row) => this.keep(row) && this.search(row).toLowerCase().includes(wanted));
    const shown = fitting.slice(0, MOST_SHOWN);
    const lines = shown.map((row) => this.line(row));
    const same = lines.length === this.body.children.length
      && lines.every((line, index) => line === this.body.children[index]);
    if (!same) this.body.replaceChildren(...lines);
    const left = fitting.length - shown.length;
    this.more.textContent = left > 0
      ? t(`${left} more: type a part of the name above`, `还有 ${left} 项：在上面输入名称的一部分`)
      : fitting.length ? "" : t("nothing here", "没有内容");
  }

  /** The row's line, written anew where the row has changed. */
  line(row) {
    let made = this.made.get(row.name);
    if (!made) {
      const cells = this.columns.map(({ className = "" }) => element("td", { class: className }));
      made = { line: element("tr", { "data-name": row.name }, ...cells), cells, written: "" };
      if (this.onOpen) made.line.addEventListener("click", () => this.open(row.name));
      this.made.set(row.name, made);
    }
    const written = JSON.stringify(row);
    if (made.written !== written) {
      made.written = written;
      this.columns.forEach(({ write }, index) => write(made.cells[index], row));
    }
    return made.line;
  }

  open(name) {
    this.made.get(this.chosen)?.line.classList.remove("chosen");
    this.chosen = name;
    this.made.get(name)?.line.classList.add("chosen");
    const row = this.rows.find((one) => one.name === name);
    if (row) this.onOpen(row);
  }
}

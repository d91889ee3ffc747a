// The parameter server as a tree by namespace; one parameter can be looked at in full and set.

import { element } from "../dom.js";
import { t } from "../language.js";
import { errorLine, onlyLooking, reveal, workButton } from "./parts.js";

export const title = t("Parameters", "参数");

const TYPING_MS = 150;
const FEW = 40; // parameters that are all unfolded at once
const kept = { open: new Set(), text: "" };

/** `[namespace, rows]` in order; a namespace is all but a name's last part. */
function byNamespace(rows) {
  const found = new Map();
  for (const row of rows) {
    const place = row.name.slice(0, row.name.lastIndexOf("/")) || "/";
    if (!found.has(place)) found.set(place, []);
    found.get(place).push(row);
  }
  return [...found].sort(([one], [other]) => (one < other ? -1 : 1));
}

/** The editor of one parameter in `place`; `changed()` after it was set or deleted. */
async function editor(place, row, link, changed) {
  const problem = errorLine();
  const name = element("input", {
    id: "parameter-name", class: "mono", value: row.name, readonly: row.type !== "",
    placeholder: "/name", spellcheck: "false", autocapitalize: "off",
  });
  const value = element("textarea", {
    id: "parameter-value", rows: 6, spellcheck: "false", autocapitalize: "off",
  });
  const facts = element("p", { class: "muted", text: row.type });
  place.replaceChildren(name, facts, problem, value);
  reveal(place);
  value.value = row.value;
  let cut = row.cut;
  if (cut) {
    try {
      const whole = await link.call("parameter", { name: row.name });
      [value.value, cut] = [whole.value, whole.cut];
    } catch (error) {
      problem.show(error.message);
    }
  }
  if (cut) problem.show(t("too long to edit here", "太长，无法在此编辑"));
  value.rows = Math.min(24, 3 + value.value.split("\n").length);
  if (!link.control) {
    place.append(onlyLooking());
    return;
  }
  const set = workButton("parameter-set", t("set", "设置"), problem, async () => {
    const now = await link.call("set_parameter", { name: name.value, value: value.value });
    facts.textContent = t(`set: ${now.type}`, `已设置：${now.type}`);
    await changed();
  }, "primary");
  const drop = workButton("parameter-delete", t("delete", "删除"), problem, async () => {
    if (!window.confirm(t(`Delete ${name.value}?`, `删除 ${name.value}？`))) return;
    await link.call("delete_parameter", { name: name.value });
    place.replaceChildren();
    await changed();
  });
  set.disabled = cut;
  place.append(element("div", { class: "row" }, set, row.type ? drop : ""),
    element("p", { class: "muted", text: t(
      "The value is YAML: 1, 1.0, true, text, [1, 2], {a: 1}. Most nodes read it as they start.",
      "值用 YAML 写：1、1.0、true、text、[1, 2]、{a: 1}。多数节点只在启动时读取。") }));
}

export function mount(place, link) {
  const problem = errorLine();
  const tree = element("div", { id: "parameters", class: "tree" });
  const detail = element("div", { class: "detail", id: "parameter-detail" });
  let rows = [];

  const leaf = (row) => element("button", {
    class: "leaf mono", "data-name": row.name, onclick: () => editor(detail, row, link, read),
  }, element("span", { text: row.name.slice(row.name.lastIndexOf("/") + 1) }),
  element("span", { class: "muted", text: row.value.slice(0, 80) }));

  function branch([namespace, members], unfolded) {
    const folder = element("details", { open: unfolded || kept.open.has(namespace) },
      element("summary", { class: "mono", text: `${namespace} (${members.length})` }));
    const fill = () => {
      if (folder.open && folder.children.length === 1) folder.append(...members.map(leaf));
    };
    folder.addEventListener("toggle", () => {
      if (folder.open) kept.open.add(namespace);
      else kept.open.delete(namespace);
      fill();
    });
    fill();
    return folder;
  }

  function draw() {
    const wanted = kept.text.toLowerCase();
    const fitting = rows.filter(
      (row) => `${row.name} ${row.value}`.toLowerCase().includes(wanted));
    const unfolded = fitting.length <= FEW;
    tree.replaceChildren(...byNamespace(fitting).map((one) => branch(one, unfolded)));
  }

  async function read() {
    rows = await link.call("parameters");
    draw();
  }

  let timer = null;
  const filter = element("input", {
    type: "search", id: "parameters-search", placeholder: t("filter", "筛选"), value: kept.text,
    oninput: () => {
      clearTimeout(timer);
      timer = setTimeout(() => {
        kept.text = filter.value.trim();
        draw();
      }, TYPING_MS);
    },
  });
  const refresh = workButton("parameters-refresh", t("refresh", "刷新"), problem, read);
  const fresh = { name: "", type: "", value: "", cut: false };
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" }, filter, refresh, link.control ? element("button", {
      text: t("new", "新建"), onclick: () => editor(detail, fresh, link, read),
    }) : ""),
    problem, element("div", { class: "split" }, tree, detail)));
  refresh.click();
}

export function unmount() {}

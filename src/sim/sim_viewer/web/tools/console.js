// The log of all nodes, with levels and a filter.

import { element } from "../dom.js";
import { t } from "../language.js";
import { choice, errorLine, timeText, toldError } from "./parts.js";

export const title = t("Console", "日志");

const MOST_KEPT = 3000; // lines
const MOST_SHOWN = 400;
const TYPING_MS = 200;
const LEVELS = ["debug", "info", "warn", "error", "fatal"];
const NAMES = [
  ["debug", t("all levels", "全部级别")],
  ["info", t("info and graver", "info 及以上")],
  ["warn", t("warnings and graver", "警告及以上")],
  ["error", t("errors and graver", "错误及以上")],
  ["fatal", t("fatal only", "仅 fatal")],
];
const settings = { level: "info", pattern: "" };
let stops = [];

/** Tests a line's node and text; a pattern that is no regular expression is looked for as it is. */
export function matcher(pattern) {
  if (!pattern) return () => true;
  try {
    const expression = new RegExp(pattern, "i");
    return (line) => expression.test(line.node) || expression.test(line.text);
  } catch {
    const part = pattern.toLowerCase();
    return (line) => `${line.node} ${line.text}`.toLowerCase().includes(part);
  }
}

export function mount(place, link) {
  const problem = errorLine();
  const list = element("div", { class: "log mono", id: "console-lines" });
  const count = element("span", { class: "muted", id: "console-count" });
  let lines = [];
  let fits = () => true;
  let held = false;

  const wanted = (line) => LEVELS.indexOf(line.level) >= LEVELS.indexOf(settings.level)
    && fits(line);
  const entry = (line) => element("div", { class: `line ${line.level}`, title: line.place },
    element("span", { class: "time", text: timeText(line.time, 3) }),
    element("span", { class: "level", text: line.level }),
    element("span", { class: "node", text: line.node }),
    element("span", { class: "text", text: line.text }));
  const counted = () => (count.textContent = t(`${lines.length} lines`, `${lines.length} 行`));

  function append(fresh) {
    const atEnd = list.scrollHeight - list.scrollTop - list.clientHeight < 40;
    list.append(...fresh.map(entry));
    while (list.children.length > MOST_SHOWN) list.firstChild.remove();
    if (atEnd) list.scrollTop = list.scrollHeight;
    counted();
  }

  function redraw() {
    try {
      new RegExp(settings.pattern);
      problem.show("");
    } catch (error) {
      problem.show(t(`${error.message}; looked for as plain text`, `${error.message}；按普通文本查找`));
    }
    fits = matcher(settings.pattern);
    list.replaceChildren();
    append(lines.filter(wanted).slice(-MOST_SHOWN));
    list.scrollTop = list.scrollHeight;
  }

  function take(data) {
    if (toldError(data, problem)) return;
    lines = lines.concat(data.lines).slice(-MOST_KEPT);
    if (data.left_out) {
      append([{ time: data.lines[0].time, level: "warn", node: "", place: "",
        text: t(`${data.left_out} lines left out`, `省略了 ${data.left_out} 行`) }]);
    }
    if (!held) append(data.lines.filter(wanted));
  }

  let timer = null;
  const pattern = element("input", {
    type: "search", id: "console-filter", value: settings.pattern, autocapitalize: "off",
    placeholder: t("filter (regular expression)", "筛选（正则表达式）"),
    oninput: () => {
      clearTimeout(timer);
      timer = setTimeout(() => {
        settings.pattern = pattern.value;
        redraw();
      }, TYPING_MS);
    },
  });
  const hold = element("button", { text: t("hold", "停住"), onclick: () => {
    held = !held;
    hold.textContent = held ? t("go on", "继续") : t("hold", "停住");
    if (!held) redraw();
  } });
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" },
      choice("console-level", NAMES, settings.level, (level) => {
        settings.level = level;
        redraw();
      }), pattern, hold,
      element("button", { text: t("clear", "清空"), onclick: () => {
        lines = [];
        redraw();
      } }), count),
    problem, list));
  stops = [
    // After a reconnection the server sends its last lines again.
    link.onConnection((there) => {
      if (!there) return;
      lines = [];
      redraw();
    }),
    link.watch("console", { level: "debug" }, take, problem.show),
  ];
}

export function unmount() {
  stops.forEach((stop) => stop());
  stops = [];
}

// Small parts that several tools are made of.

import { element } from "../dom.js";
import { t } from "../language.js";

/** A line for what went wrong: `show(text)`, and `show("")` when it has passed. */
export function errorLine() {
  const line = element("p", { class: "error", role: "alert", hidden: true });
  line.show = (text) => {
    line.textContent = text;
    line.hidden = !text;
  };
  return line;
}

/** A checkbox with its label, and an id where it needs one; `onchange(checked)`. */
export function checkbox(id, text, checked, onchange) {
  const box = element("input", {
    type: "checkbox", ...(id ? { id } : {}), checked, onchange: () => onchange(box.checked),
  });
  return element("label", { class: "check" }, box, element("span", { text }));
}

/** A select of `[value, text]`; `onchange(value)`. */
export function choice(id, options, value, onchange) {
  const made = element("select", { id, onchange: () => onchange(made.value) },
    ...options.map(([one, text]) => element("option", { value: one, text })));
  made.value = value;
  return made;
}

/** A button that is off while its work is under way; errors go to `line`. */
export function workButton(id, text, line, work, className = "") {
  const button = element("button", {
    id, text, class: className,
    onclick: async () => {
      button.disabled = true;
      line.show("");
      try {
        await work();
      } catch (error) {
        line.show(error.message);
      }
      button.disabled = false;
    },
  });
  return button;
}

/** What a page that may only look shows in place of a button. */
export function onlyLooking() {
  return element("p", {
    class: "muted", text: t("This page may only look; start it with control:=true.",
      "此页面只读；用 control:=true 启动后才能操作。"),
  });
}

/** Have it seen: on a narrow screen it stands above the list that was tapped. */
export function reveal(detail) {
  detail.scrollIntoView({ block: "nearest" });
}

/** Write a name into a cell; where it must be broken, that is behind a slash. */
export function writeName(cell, name) {
  const parts = name.split(/(?<=\/)/);
  cell.replaceChildren(...parts.flatMap((part) => [part, element("wbr")]));
}

export function bytes(count) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let step = 0;
  while (count >= 1000 && step < units.length - 1) {
    count /= 1000;
    step += 1;
  }
  return `${step && count < 100 ? count.toFixed(1) : Math.round(count)} ${units[step]}`;
}

/** A time in s as a person reads it: of the day where it is a wall's, else simulated seconds. */
export function timeText(time, digits) {
  if (time < 1e8) return time.toFixed(digits);
  const whole = Math.floor(time);
  const clock = new Date(whole * 1000).toTimeString().slice(0, 8);
  return digits ? clock + (time - whole).toFixed(digits).slice(1) : clock;
}

/** Shows a watchable's `{error}`; true if it was one. */
export function toldError(data, line) {
  line.show(data?.error ?? "");
  return Boolean(data?.error);
}

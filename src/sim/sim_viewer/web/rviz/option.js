// An input for each kind of option that a display has.

import { element } from "../dom.js";
import { checkbox, choice } from "../tools/parts.js";

const hex = (rgb) => "#" + rgb.split(";").map((one) => Number(one).toString(16).padStart(2, "0"))
  .join("");
const rgb = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)).join("; ");

const numeric = (step) => (option, value, set) => {
  const box = element("input", { type: "number", step, min: option.low, max: option.high, value,
    onchange: () => box.checkValidity() && box.value && set(Number(box.value)) });
  return box;
};

const INPUTS = {
  color: (option, value, set) => {
    const box = element("input", { type: "color", value: hex(value),
      oninput: () => set(rgb(box.value)) });
    return box;
  },
  number: numeric("any"),
  integer: numeric(1),
  switch: (option, value, set) => checkbox("", "", value, set),
  choice: (option, value, set) => choice("", option.choices.map((one) => [one, one]), value, set),
  text: (option, value, set) => {
    const box = element("input", { value, onchange: () => set(box.value) });
    return box;
  },
  namespaces: (option, value, set) => element("span", {}, ...Object.keys(value).map((name) =>
    checkbox("", name, value[name], (wanted) => set({ ...value, [name]: wanted })))),
};
INPUTS.frame = INPUTS.text;

/** A line with an option's name and its input; `set(value)` for each change. */
export function optionLine(option, value, set) {
  return element("label", { class: "option", "data-option": option.name },
    element("span", { text: option.name.replace(/\/Value$/, "") }), INPUTS[option.kind](option, value, set));
}

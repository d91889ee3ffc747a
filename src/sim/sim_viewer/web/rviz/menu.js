// A marker's menu: entries below entries, in a list beside the pointer.

import { element } from "../dom.js";
import { t } from "../language.js";

export class Menu {
  /** `entries` are `{id, parent, title, works}`, parent 0 at the top; `choose(id)` for a click. */
  constructor(parent, event, entries, choose) {
    this._choose = choose;
    this._below = new Map(); // parent -> entries
    for (const one of entries) {
      this._below.set(one.parent, [...(this._below.get(one.parent) ?? []), one]);
    }
    const { left, top } = parent.getBoundingClientRect();
    this._element = element("div", { class: "rviz-menu" }, this._list(0));
    parent.append(this._element);
    const { style, offsetWidth, offsetHeight } = this._element;
    style.left = `${Math.min(event.clientX - left, parent.clientWidth - offsetWidth)}px`;
    style.top = `${Math.min(event.clientY - top, parent.clientHeight - offsetHeight)}px`;
  }

  close() {
    this._element.remove();
  }

  _list(parent) {
    const entries = this._below.get(parent) ?? [];
    this._below.delete(parent); // or one that is its own parent would have no end
    return element("ul", {}, ...entries.map((one) => element("li", {}, this._entry(one),
      ...(this._below.has(one.id) ? [this._list(one.id)] : []))));
  }

  _entry({ id, title, works }) {
    if (this._below.has(id)) return element("span", { text: title });
    return element("button", { text: title, disabled: !works, "data-entry": id,
      title: works ? "" : t("starts a program: not from a page", "启动程序的条目在网页中不可用"),
      onclick: () => {
        this.close();
        this._choose(id);
      } });
  }
}

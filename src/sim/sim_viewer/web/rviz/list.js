// The list of displays: statuses, topics and options of each, and buttons to add and remove them.

import { element } from "../dom.js";
import { t } from "../language.js";
import { checkbox, choice } from "../tools/parts.js";
import { optionLine } from "./option.js";
import { Session, worst } from "./session.js";

const short = (name) => name.replace(/^rviz\//, "");

export class DisplayList {
  constructor(session, link) {
    this._session = session;
    this._topics = new Map(); // type -> names
    this._entries = new Map(); // display -> {status}
    this._displays = element("div", { class: "rviz-displays" });
    this._fixed = element("input", { id: "rviz-fixed", list: "rviz-frames", value: session.fixed,
      onchange: () => this._fix(this._fixed.value) });
    this._frames = element("datalist", { id: "rviz-frames" });
    this._target = element("input", { id: "rviz-target", list: "rviz-frames",
      value: session.target, onchange: () => session.follow(this._target.value) });
    this._global = element("p", { class: "status", id: "rviz-global" });
    this.element = element("div", { class: "rviz-list" },
      element("label", { class: "option" },
        element("b", { text: t("Fixed frame", "固定坐标系") }), this._fixed, this._frames),
      this._global, element("label", { class: "option" },
        element("span", { text: t("Camera follows", "视角跟随") }), this._target),
      this._displays, this._adder());
    session.displays.forEach((display) => this._show(display));
    this._link = link;
    this._stopTopics = link.watch("topics", {}, (rows) => this._learn(rows));
    this._watchFrames();
  }

  close() {
    this._stopTopics();
    this._stopFrames();
  }

  /** A display's statuses have changed. */
  tell(display) {
    const entry = this._entries.get(display);
    if (!entry) return;
    const [, level, text] = worst(display.statuses);
    entry.element.dataset.level = display.enabled ? level : "";
    entry.trouble.textContent = display.enabled && level !== "ok" ? text : "";
    entry.trouble.className = `status ${level}`;
    entry.showNamespaces(display.namespaces);
    entry.status.replaceChildren(...display.statuses.map(([name, level, text]) =>
      element("p", { class: `status ${level}`, text: `${name}: ${text}` })));
  }

  _adder() {
    const names = [...this._session.types.keys()];
    const kinds = choice("rviz-kind", names.map((name) => [name, short(name)]), names[0], () => {});
    return element("div", { class: "row" }, kinds, element("button", {
      id: "rviz-add", text: t("Add", "添加"), onclick: () => {
        const display = this._session.add(kinds.value, this._topics);
        this._show(display).open = true;
        this._session.restart(display);
      } }));
  }

  _show(display) {
    const kind = this._session.types.get(display.class);
    const status = element("div", { class: "statuses" });
    const trouble = element("span");
    const box = checkbox("", "", display.enabled, (wanted) => {
      display.enabled = wanted;
      this._session.restart(display);
    });
    const made = element("details", { class: "rviz-display", "data-name": display.name },
      element("summary", {}, element("span", { class: "level" }), box,
        element("span", { class: "name", text: display.name }),
        element("span", { class: "muted", text: short(display.class) }),
        element("button", { class: "remove", text: "✕", title: t("remove", "移除"),
          onclick: () => this._remove(display) }), trouble),
      status, ...(kind ? this._settings(display, kind) : []));
    this._entries.set(display, { element: made, status, trouble,
      showNamespaces: (names) => this._showNamespaces(display, made, names) });
    this._displays.append(made);
    this.tell(display);
    return made;
  }

  /** Markers say which namespaces there are; each can be hidden. */
  _showNamespaces(display, made, names = []) {
    const shown = display.options.Namespaces ?? {};
    const unknown = names.filter((name) => !(name in shown));
    if (!unknown.length) return;
    display.options.Namespaces = { ...shown, ...Object.fromEntries(
      unknown.map((name) => [name, true])) };
    const option = this._session.types.get(display.class).options.find(
      (one) => one.name === "Namespaces");
    made.querySelector("[data-option=Namespaces]").replaceWith(this._option(display, option));
  }

  _option(display, option) {
    return optionLine(option, display.options[option.name], (value) => {
      display.options = { ...display.options, [option.name]: value };
      display.shown?.change(this._session.fixed);
    });
  }

  _settings(display, kind) {
    const lines = kind.options.map((option) => this._option(display, option));
    if (!kind.messages.length) return lines;
    const known = element("datalist", { id: `rviz-topics-${display.id}` });
    const topic = element("input", { class: "topic", list: known.id, value: display.topic,
      onfocus: () => known.replaceChildren(...kind.messages.flatMap((type) =>
        (this._topics.get(type) ?? []).map((value) => element("option", { value })))),
      onchange: () => {
        display.topic = topic.value.trim();
        display.topic_is_default = false;
        this._session.restart(display);
      } });
    return [element("label", { class: "option" },
      element("span", { text: t("Topic", "话题") }), topic, known), ...lines];
  }

  _remove(display) {
    this._session.remove(display);
    this._entries.get(display).element.remove();
    this._entries.delete(display);
  }

  _learn(rows) {
    if (!Array.isArray(rows)) return;
    this._topics.clear();
    for (const { name, type, publishers } of rows) {
      if (publishers.length) this._topics.set(type, [...(this._topics.get(type) ?? []), name]);
    }
    for (const [display, { element: entry }] of this._entries) {
      if (!this._session.choose(display, this._topics)) continue;
      entry.querySelector("input.topic").value = display.topic;
      this._session.restart(display);
    }
  }

  _fix(frame) {
    if (!frame || frame === this._session.fixed) return;
    this._fixed.value = frame;
    this._session.fix(frame);
    this._stopFrames();
    this._watchFrames();
  }

  _watchFrames() {
    this._stopFrames = this._link.watch("rviz_frames", { frame: this._session.fixed },
      ({ frames, status }) => {
        if (!frames) return;
        this._frames.replaceChildren(...Object.keys(frames).map((value) =>
          element("option", { value })));
        if (!this._session.fixed) this._fix(Session.likely(frames));
        const [level, text] = status;
        this._global.className = `status ${level}`;
        this._global.textContent = level === "ok" ? "" : text;
      });
  }
}

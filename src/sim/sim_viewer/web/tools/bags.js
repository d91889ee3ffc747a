// Bags: record topics into a file on the server, look into it, play it.

import { element } from "../dom.js";
import { t } from "../language.js";
import { FilteredTable } from "./filtered_table.js";
import {
  bytes, checkbox, choice, errorLine, onlyLooking, reveal, toldError, workButton,
} from "./parts.js";

export const title = t("Bags", "录包");

const RATES = [0.1, 0.25, 0.5, 1, 2, 5, 10];
let stops = [];

const seconds = (value) => `${value.toFixed(1)} s`;
const write = (read) => (cell, row) => (cell.textContent = read(row));

/** What is in a bag, and the buttons that play it, in `place`. */
async function contents(place, row, link, problem) {
  const options = { rate: 1, loop: false, clock: false };
  const facts = element("p", { class: "muted", text: "…" });
  const list = element("table", { class: "list", id: "bag-topics" });
  const play = workButton("bag-play", t("play", "播放"), problem,
    () => link.call("play", { name: row.name, ...options }), "primary");
  place.replaceChildren(element("h3", { class: "mono", text: row.name }), facts,
    link.control ? element("div", { class: "row" }, play,
      choice("bag-rate", RATES.map((rate) => [rate, `× ${rate}`]), 1,
        (rate) => (options.rate = Number(rate))),
      checkbox("bag-loop", t("again and again", "循环"), false, (on) => (options.loop = on)),
      checkbox("bag-clock", t("with /clock", "发布 /clock"), false, (on) => (options.clock = on)))
      : "", list);
  try {
    const bag = await link.call("bag_info", { name: row.name });
    facts.textContent = t(`${seconds(bag.duration)}, ${bag.messages} messages`,
      `${seconds(bag.duration)}，${bag.messages} 条消息`);
    list.replaceChildren(...bag.topics.map((topic) => element("tr", {},
      element("td", { class: "mono", text: topic.name }),
      element("td", { class: "mono", text: topic.type }),
      element("td", { text: topic.count }))));
  } catch (error) {
    facts.textContent = "";
    problem.show(error.message);
  }
}

/** The form that begins a recording, with the topics to choose from. */
function recorder(link, problem) {
  const chosen = new Set();
  const name = element("input", {
    id: "bag-name", placeholder: t("name (the time if empty)", "名称（留空则用时间）"),
    spellcheck: "false", autocapitalize: "off",
  });
  const count = element("span", { class: "muted" });
  const counted = () => (count.textContent = chosen.size
    ? t(`${chosen.size} topics`, `${chosen.size} 个话题`) : t("all topics", "全部话题"));
  const table = new FilteredTable({
    id: "bag-choice",
    search: (row) => `${row.name} ${row.type}`,
    columns: [{
      title: t("only these topics", "仅录制这些话题"), className: "mono", write: (cell, row) => {
        cell.replaceChildren(checkbox("", row.name, chosen.has(row.name), (on) => {
          if (on) chosen.add(row.name);
          else chosen.delete(row.name);
          counted();
        }));
      },
    }],
  });
  const record = workButton("bag-record", t("record", "录制"), problem,
    () => link.call("record", { name: name.value.trim(), topics: [...chosen] }), "primary");
  const stop = link.watch("topics", {}, (rows) => {
    if (Array.isArray(rows)) table.update(rows.map((row) => ({ name: row.name, type: row.type })));
  }, problem.show);
  counted();
  return {
    stop,
    element: element("div", {}, element("div", { class: "row" }, name, record, count),
      element("details", {}, element("summary", { text: t("choose topics", "选择话题") }),
        element("div", { class: "row" }, table.box), table.element)),
  };
}

/** A line that shows what runs, with a button that ends it. */
function progress(id, op, link, problem) {
  const text = element("span", { id });
  const stop = workButton(`${id}-stop`, t("stop", "停止"), problem, () => link.call(op));
  const line = element("div", { class: "row card running", hidden: true }, text,
    link.control ? stop : "");
  line.show = (state, what) => {
    line.hidden = !state;
    if (state) {
      text.textContent = `${what} ${state.name}: ${seconds(state.seconds)}, ${bytes(state.size)}`;
    }
  };
  return line;
}

export function mount(place, link) {
  const problem = errorLine();
  const note = errorLine();
  const folder = element("p", { class: "muted mono" });
  const detail = element("div", { class: "detail", id: "bag-detail" });
  const recording = progress("bag-recording", "stop_record", link, problem);
  const playing = progress("bag-playing", "stop_play", link, problem);
  const begin = link.control ? recorder(link, problem) : null;
  const table = new FilteredTable({
    id: "bags",
    columns: [
      { title: t("bag", "包"), className: "mono", write: write((row) => row.name) },
      { title: t("size", "大小"), className: "number", write: write((row) => bytes(row.size)) },
      { title: t("when", "时间"), className: "wide",
        write: write((row) => new Date(row.changed * 1000).toLocaleString()) },
    ],
    onOpen: (row) => {
      contents(detail, row, link, problem);
      reveal(detail);
    },
  });
  place.append(element("div", { class: "pad tool" }, begin ? begin.element : onlyLooking(),
    recording, playing, problem, note, folder,
    element("div", { class: "split" },
      element("div", {}, element("div", { class: "row" }, table.box), table.element), detail)));
  const stop = link.watch("bags", {}, (state) => {
    if (toldError(state, note)) return;
    note.show(state.note);
    folder.textContent = state.folder;
    recording.show(state.recording, t("recording", "正在录制"));
    playing.show(state.playing, t("playing", "正在播放"));
    table.update(state.bags);
  }, problem.show);
  stops = [stop, () => begin?.stop()];
}

export function unmount() {
  stops.forEach((stop) => stop());
  stops = [];
}

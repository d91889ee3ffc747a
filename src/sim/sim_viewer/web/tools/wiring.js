// Who talks to whom: the robot's inputs and sensors, and sentences on what is wrong there.

import { element } from "../dom.js";
import { t } from "../language.js";
import { writeName } from "./parts.js";

const NOBODY = t("nobody", "无");

function names(nodes) {
  return nodes.length
    ? element("td", { class: "mono", text: nodes.join(", ") })
    : element("td", { class: "muted", text: NOBODY });
}

function line(row) {
  const topic = element("td", { class: "mono", title: row.type });
  writeName(topic, row.name);
  return element("tr", { "data-name": row.name },
    element("td", { text: row.part === "input" ? t("hears", "接收") : t("sends", "发送") }),
    topic, names(row.part === "input" ? row.from : row.to));
}

/** Shows them in `place` until the result is called; `onError(line)` where that fails. */
export function showWiring(place, link, onError) {
  const faults = element("ul", { id: "wiring-faults" });
  const loose = element("ul", { class: "muted", id: "wiring-loose" });
  const more = element("details", {}, element("summary", {
    text: t("topics with one end", "只有一端的话题") }), loose);
  const body = element("tbody");
  const none = element("p", { class: "muted", text: t("no robot yet", "还没有机器人") });
  const table = element("table", { class: "list", id: "wiring" },
    element("thead", {}, element("tr", {},
      element("th", { text: t("robot", "机器人") }), element("th", { text: t("topic", "话题") }),
      element("th", { text: t("with", "对方") }))), body);
  place.append(element("details", { open: true, class: "wiring" },
    element("summary", { text: t("Who talks to whom", "谁和谁通信") }), faults, table, none, more));
  return link.watch("wiring", {}, (data) => {
    if (data.error) return; // the drawing says so
    faults.replaceChildren(...data.faults.map((text) => element("li", { text })));
    loose.replaceChildren(...data.loose.map((text) => element("li", { text })));
    more.hidden = !data.loose.length;
    body.replaceChildren(...data.rows.map(line));
    table.hidden = !data.rows.length;
    none.hidden = data.rows.length > 0;
  }, onError);
}

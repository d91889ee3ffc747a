// Services: the list, a form for a request, and the answer.

import { element } from "../dom.js";
import { t } from "../language.js";
import { FilteredTable } from "./filtered_table.js";
import { checkbox, errorLine, onlyLooking, reveal, workButton } from "./parts.js";

export const title = t("Services", "服务");

// Every rospy and roscpp node has these two.
const LOGGERS = /\/(get_loggers|set_logger_level)$/;
const settings = { hideLoggers: true };

/** The form of one service in `place`. */
async function form(place, row, link) {
  const problem = errorLine();
  const heading = element("h3", { class: "mono", text: row.name });
  place.replaceChildren(heading, problem);
  let facts;
  try {
    facts = await link.call("service", { name: row.name });
  } catch (error) {
    problem.show(error.message);
    return;
  }
  if (place.firstChild !== heading) return; // another was chosen meanwhile
  const request = element("textarea", {
    id: "service-request", rows: Math.min(20, 2 + facts.request.split("\n").length),
    spellcheck: "false", autocapitalize: "off",
  });
  request.value = facts.request;
  const answer = element("pre", { id: "service-response", class: "card", text: facts.response });
  const label = element("p", { class: "muted", text: t("answers with", "应答格式") });
  const call = workButton("service-call", t("call", "调用"), problem, async () => {
    answer.textContent = "…";
    const begun = performance.now();
    try {
      answer.textContent = await link.call("call_service",
        { name: row.name, request: request.value });
      label.textContent = t(`answer after ${Math.round(performance.now() - begun)} ms`,
        `${Math.round(performance.now() - begun)} ms 后的应答`);
    } catch (error) {
      answer.textContent = "";
      throw error;
    }
  }, "primary");
  reveal(place);
  place.append(element("p", { class: "mono", text: facts.type }),
    element("p", {}, element("span", { class: "muted", text: t("served by", "提供者") }),
      ` ${row.node}`),
    request, link.control ? element("div", { class: "row" }, call) : onlyLooking(),
    label, answer);
}

export function mount(place, link) {
  const problem = errorLine();
  const detail = element("div", { class: "detail", id: "service-detail" },
    element("p", { class: "muted", text: t("Choose a service to fill in its request.",
      "选择一个服务以填写请求。") }));
  const write = (read) => (cell, row) => (cell.textContent = read(row));
  const table = new FilteredTable({
    id: "services",
    search: (row) => `${row.name} ${row.node}`,
    keep: (row) => !settings.hideLoggers || !LOGGERS.test(row.name),
    columns: [
      { title: t("service", "服务"), className: "mono", write: write((row) => row.name) },
      { title: t("node", "节点"), className: "mono wide", write: write((row) => row.node) },
    ],
    onOpen: (row) => form(detail, row, link),
  });
  const read = async () => table.update(await link.call("services"));
  const refresh = workButton("services-refresh", t("refresh", "刷新"), problem, read);
  place.append(element("div", { class: "pad tool" },
    element("div", { class: "row" }, table.box, refresh,
      checkbox("", t("hide loggers", "隐藏日志服务"), settings.hideLoggers, (hide) => {
        settings.hideLoggers = hide;
        table.draw();
      })),
    problem, element("div", { class: "split" }, table.element, detail)));
  refresh.click();
}

export function unmount() {}

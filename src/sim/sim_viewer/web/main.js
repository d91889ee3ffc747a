// The page's frame: tabs, the connection's light, and the simulation's state and buttons.

import { element } from "./dom.js";
import { language, switchLanguage, t } from "./language.js";
import { call, connected, onConnection, tell, watch } from "./link.js";
import { simulationBar } from "./simulation_bar.js";
import { TABS } from "./tabs.js";
import { timeline } from "./timeline.js";

const link = { call, tell, watch, onConnection, connected, control: false };
const content = document.getElementById("content");
const tabs = {};
let open = null;

function show(name) {
  if (!tabs[name] || open === name) return;
  if (open) {
    tabs[open].module.unmount?.();
    tabs[open].button.setAttribute("aria-selected", "false");
  }
  open = name;
  content.replaceChildren();
  tabs[name].button.setAttribute("aria-selected", "true");
  tabs[name].button.scrollIntoView({ block: "nearest", inline: "nearest" });
  history.replaceState(null, "", `#${name}`);
  tabs[name].module.mount(content, link);
}

function addTab(name, module) {
  const button = element("button", {
    role: "tab", id: `tab-${name}`, text: module.title, "aria-selected": "false",
    onclick: () => show(name),
  });
  tabs[name] = { module, button };
  document.getElementById("tabs").append(button);
}

function wireFrame() {
  document.documentElement.lang = language === "zh" ? "zh-CN" : "en";
  const button = document.getElementById("language");
  button.textContent = language === "zh" ? "English" : "中文";
  button.onclick = switchLanguage;
  const lessons = document.getElementById("lessons");
  lessons.href = `lessons/${language}/index.html`;
  lessons.textContent = t("Lessons", "课程");
  const light = document.getElementById("light");
  onConnection((there) => {
    light.className = there ? "on" : "off";
    light.title = there ? t("connected", "已连接") : t("no connection", "未连接");
  });
}

/** Resolves when the server has said whether this page may change anything. */
function untilConnected() {
  let known = false;
  return new Promise((resolve) => onConnection(async (there) => {
    const about = there && await call("about").catch(() => null);
    if (!about) return;
    // Started anew, with control:=true now or without it: what is shown was made for the other.
    if (known && about.control !== link.control) location.reload();
    link.control = about.control;
    const version = document.getElementById("version");
    version.textContent = `v${about.version}`;
    version.title = t("version of these courses", "本课程的版本");
    known = true;
    resolve();
  }));
}

async function start() {
  wireFrame();
  const loading = Object.entries(TABS).map(async ([name, path]) => [name, await import(path)]);
  const [loaded] = await Promise.all([Promise.allSettled(loading), untilConnected()]);
  simulationBar(document.getElementById("simulation"), link);
  timeline(document.getElementById("timeline"), link);
  for (const one of loaded) {
    if (one.status === "fulfilled") addTab(...one.value);
    else console.error(one.reason);
  }
  const wished = location.hash.slice(1);
  show(tabs[wished] ? wished : Object.keys(tabs)[0]);
}

start();

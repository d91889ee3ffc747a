// Under all tabs, of a run in lockstep: its time with marks. In a replay, the way to each image.

import { element } from "./dom.js";
import { t } from "./language.js";
import { TimeBar } from "./replay/time_bar.js";

const SLACK = 1e-5; // s

/** Fill `place`; it follows the watches `timeline` and `status` as long as the page is open. */
export function timeline(place, link) {
  let run = { times: [] };
  let now = 0; // s
  let wish = null; // where to go next, while `busy`
  let busy = false;
  const text = element("span", { id: "moment-text", class: "mono" });
  const said = element("span", { id: "moment-said", class: "error" });
  const back = element("span", { id: "moment-back", class: "row", hidden: true });
  const button = (id, label, title, onclick) => element("button", { id, text: label, title, onclick });
  const bar = new TimeBar("moment", (time) => choose(imageAt(time)), (time) => say(imageAt(time)));
  const previous = button("image-before", "◀", t("the image before (←)", "上一帧图像（←）"),
    () => choose(shown() - 1));
  const next = button("image-next", "▶", t("the next image (→)", "下一帧图像（→）"),
    () => choose(shown() + 1));
  const drive = button("drive-on", t("Drive on", "从这里接着开"), t(
    "The world goes on from this image; your program, started beside it, drives.",
    "世界从这帧图像继续，由你另外启动的程序驾驶。"), () => go("go").then(travel));

  /** Number of the last image up to a time, from 1. */
  function imageAt(time) {
    const after = run.times.findIndex((one) => one > time + SLACK);
    return Math.max(1, after < 0 ? run.times.length : after);
  }

  /** The image that is gone to, or where the world is. */
  function shown() {
    return wish?.image ?? imageAt(now);
  }

  function say(image) {
    const time = run.times[image - 1] ?? 0;
    text.textContent = t("image", "图像") + ` ${image}/${run.times.length}, ${time.toFixed(3)} s`;
  }

  function choose(image) {
    if (image < 1 || image > run.times.length) return;
    said.textContent = "";
    if (run.command) {
      offer(image);
      return;
    }
    if (!link.control) {
      present();
      said.textContent = t(
        `This page may only look: type image:${image} where make replay runs, or start that with ` +
        "CONTROL=1.",
        `本页只能查看：请在运行 make replay 的终端里输入 image:${image}，或用 CONTROL=1 启动它。`);
      return;
    }
    wish = { image };
    bar.show(run.times[image - 1]);
    say(image);
    if (!busy) travel();
  }

  /** One way at a time: the newest wish is next. */
  async function travel() {
    while (wish) {
      const { image } = wish;
      await go(`image:${image}`);
      if (wish.image === image) wish = null;
    }
    present();
  }

  async function go(to) {
    busy = true;
    place.classList.add("busy");
    drive.disabled = true;
    said.textContent = "";
    try {
      await link.call("rewind", { to });
      if (wish && to === `image:${wish.image}`) now = run.times[wish.image - 1];
    } catch (error) {
      said.textContent = error.message;
    }
    busy = drive.disabled = false;
    place.classList.remove("busy");
  }

  /** A run that goes on is not stopped: what to type to see that image beside it. */
  function offer(image) {
    const command = `${run.command} AT=image:${image}`;
    const code = element("code", { text: command });
    bar.show(run.times[image - 1]);
    say(image);
    back.replaceChildren(
      element("span", { text: t("To go back there, while this run goes on, in a terminal:",
        "要回到那里（这次运行照常继续），在终端里输入：") }), code,
      button("copy", t("Copy", "复制"), "", (event) => {
        getSelection().selectAllChildren(code);
        navigator.clipboard?.writeText(command).then(
          () => (event.target.textContent = t("Copied", "已复制")), () => {});
      }),
      button("to-now", t("Back to now", "回到现在"), "", () => {
        back.hidden = true;
        present();
      }));
    back.hidden = false;
  }

  function present() {
    if (wish || busy || !back.hidden || !run.times.length) return;
    bar.show(now);
    if (now > run.times.at(-1) + SLACK && !run.command) {
      text.textContent = `${t("beyond the run,", "超出原来的运行，")} ${now.toFixed(3)} s`;
    } else say(imageAt(now));
  }

  bar.slider.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    choose((back.hidden ? shown() : imageAt(Number(bar.slider.value))) + step);
  });
  place.append(previous, bar.box, next, text, drive, said, back);
  link.watch("timeline", {}, (data) => {
    if (data.error) return; // no master: what is known stays
    run = { times: [], marks: [], ...data };
    place.hidden = !run.times.length;
    if (place.hidden) return;
    for (const one of [previous, next, drive]) one.hidden = Boolean(run.command) || !link.control;
    const kept = bar.slider.value;
    bar.range(run.command ? 0 : run.times[0], run.times.at(-1), run.marks);
    bar.show(kept);
    present();
  });
  link.watch("status", {}, (status) => {
    if (status.time == null) return;
    now = status.time;
    if (document.activeElement !== bar.slider || !bar.slider.matches(":active")) present();
  });
}

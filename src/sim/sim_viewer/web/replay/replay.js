// A recorded run: the 3D view, the film and the curves, all at the moment that a slider chooses.

import { element } from "../dom.js";
import { language, switchLanguage, t } from "../language.js";
import { mount } from "../scene.js";
import { plot } from "./plot.js";

const SPEEDS = [0.5, 1, 2, 4, 8];
const FEW_MS = 40; // between two pictures while it plays

const run = JSON.parse(document.getElementById("run").textContent);
const { times } = run;
const poses = new Float32Array(
  Uint8Array.from(atob(run.poses), (letter) => letter.charCodeAt(0)).buffer);
const width = 7 * run.names.length;
const first = times[0];
const last = times[times.length - 1];

/** Where everything is at a time, between two moments that were recorded. */
function rowsAt(time) {
  let next = times.findIndex((one) => one >= time);
  if (next < 0) next = times.length - 1;
  const before = Math.max(next - 1, 0);
  const share = next > before ? (time - times[before]) / (times[next] - times[before]) : 1;
  const rows = new Float32Array(width);
  for (let at = 0; at < width; at += 7) {
    const [a, b] = [before, next].map((row) => poses.subarray(row * width + at, row * width + at + 7));
    const turned = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6] < 0 ? -1 : 1;
    for (let i = 0; i < 7; i += 1) {
      rows[at + i] = a[i] + share * ((i < 3 ? 1 : turned) * b[i] - a[i]);
    }
  }
  return rows;
}

class Player {
  constructor() {
    this.time = first;
    this._moves = new Set();
    this.slider = element("input", { type: "range", id: "time", min: first, max: last, step: 0.02,
      value: first, oninput: () => { this.play(false); this.show(Number(this.slider.value)); } });
    this.text = element("span", { class: "mono" });
    this.button = element("button", { id: "play", class: "primary",
      onclick: () => this.play(!this.playing) });
    this.speed = element("select", { title: t("speed", "速度") }, ...SPEEDS.map((factor) =>
      element("option", { value: factor, text: `${factor}×`, selected: factor === 2 })));
    this.play(false);
  }

  /** As the live page's link: the 3D view watches `scene` and `poses`. */
  watch(what, _args, take) {
    if (what === "scene") {
      take(run.scene);
      return () => {};
    }
    take({ names: run.names });
    this._moves.add(take);
    take(new DataView(rowsAt(this.time).buffer));
    return () => this._moves.delete(take);
  }

  /** Where the 3D view finds a mesh or a texture; a texture that nobody could read: nothing. */
  address(path) {
    return run.files[path] ?? "data:,";
  }

  play(wanted) {
    if (wanted && this.time >= last) this.show(first);
    this.playing = wanted;
    this.button.textContent = wanted ? t("Pause", "暂停") : t("Play", "播放");
    this._at = performance.now();
    clearInterval(this._timer);
    if (wanted) this._timer = setInterval(() => this._go(), FEW_MS);
  }

  _go() {
    const now = performance.now();
    const time = Math.min(last, this.time + (now - this._at) / 1000 * Number(this.speed.value));
    this._at = now;
    this.show(time);
    if (time >= last) this.play(false);
  }

  show(time) {
    this.time = time;
    this.slider.value = time;
    this.text.textContent = `${time.toFixed(1)} s / ${last.toFixed(1)} s`;
    const rows = new DataView(rowsAt(time).buffer);
    for (const take of this._moves) take(rows);
    for (const move of this.others) move(time);
  }

  others = []; // what else shows the moment
}

/** The film; it has been made at another speed, so it is always wound to the moment. */
function filmBox(player) {
  const video = element("video", { muted: true, playsinline: true, id: "film" });
  const wind = () => {
    const wanted = (player.time - first) / (last - first) * video.duration;
    if (video.readyState && !video.seeking && Math.abs(wanted - video.currentTime) > 0.05) {
      video.currentTime = Math.min(wanted, video.duration - 0.01);
    }
  };
  fetch(run.film).then((answer) => answer.blob()).then((blob) => {
    video.src = URL.createObjectURL(blob);
  });
  for (const event of ["loadeddata", "seeked"]) video.addEventListener(event, wind);
  player.others.push(wind);
  return video;
}

const player = new Player();
const view = element("div", { class: "card view" });
const side = element("div", { class: "side" });
if (run.film) side.append(filmBox(player));
for (const picture of run.pictures) side.append(element("img", { src: picture, alt: t("path", "路线") }));
const curves = element("div", { class: "curves" });
for (const curve of run.curves) {
  const made = plot(curve, language, first, last, (time) => { player.play(false); player.show(time); });
  curves.append(made.box);
  player.others.push(made.mark);
}
document.documentElement.lang = language;
document.body.append(
  element("header", {}, element("strong", { text: run.title }), element("span", { class: "grow" }),
    element("button", { id: "language", onclick: switchLanguage,
      text: language === "zh" ? "English" : "中文" })),
  element("main", { class: "replay" },
    element("div", {}, view, element("div", { class: "row player" },
      player.button, player.slider, player.text, player.speed), curves),
    side, ...(run.text ? [element("pre", { class: "card figures", text: run.text })] : [])));
mount(view, player);
player.show(first);

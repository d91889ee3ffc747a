// A recorded run: the 3D view, the film and the curves, all at the moment that a slider chooses.

import { element } from "../dom.js";
import { language, switchLanguage, t } from "../language.js";
import { mount } from "../scene.js";
import { comparison, difference } from "./compare.js";
import { Motion } from "./motion.js";
import { Overlay } from "./overlay.js";
import { plot } from "./plot.js";
import { TimeBar } from "./time_bar.js";

const SPEEDS = [0.5, 1, 2, 4, 8];
const FEW_MS = 40; // between two pictures while it plays

const run = JSON.parse(document.getElementById("run").textContent);
const motion = new Motion(run);
const { first } = motion;

class Player {
  constructor() {
    this.time = first;
    this.last = motion.last;
    this.overlay = new Overlay(() => this.show(this.time));
    this._moves = new Set();
    this.bar = new TimeBar("time", (time) => this.choose(time));
    this.bar.range(first, this.last, run.marks);
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
    take(new DataView(motion.rowsAt(this.time).buffer));
    return () => this._moves.delete(take);
  }

  address(path) {
    return motion.address(path);
  }

  /** Lay another run over this one, or none. */
  compare(other) {
    this.last = Math.max(motion.last, other?.last ?? 0);
    this.bar.range(first, this.last, run.marks);
    this.overlay.show(motion, other);
    this.show(Math.min(this.time, this.last));
  }

  choose(time) {
    this.play(false);
    this.show(time);
  }

  play(wanted) {
    if (wanted && this.time >= this.last) this.show(first);
    this.playing = wanted;
    this.button.textContent = wanted ? t("Pause", "暂停") : t("Play", "播放");
    this._at = performance.now();
    clearInterval(this._timer);
    if (wanted) this._timer = setInterval(() => this._go(), FEW_MS);
  }

  _go() {
    const now = performance.now();
    const time = Math.min(this.last, this.time + (now - this._at) / 1000 * Number(this.speed.value));
    this._at = now;
    this.show(time);
    if (time >= this.last) this.play(false);
  }

  show(time) {
    this.time = time;
    this.bar.show(time);
    this.text.textContent = `${time.toFixed(1)} s / ${this.last.toFixed(1)} s`;
    this.overlay.move(time);
    const rows = new DataView(motion.rowsAt(time).buffer);
    for (const take of this._moves) take(rows);
    for (const { mark } of this.plots) mark(time);
    this.wind?.();
  }

  plots = [];
  wind = null; // the film
}

/** The film; it has been made at another speed, so it is always wound to the moment. */
function filmBox(player) {
  const video = element("video", { muted: true, playsinline: true, id: "film" });
  const wind = () => {
    const wanted = (player.time - first) / (motion.last - first) * video.duration;
    if (video.readyState && !video.seeking && Math.abs(wanted - video.currentTime) > 0.05) {
      video.currentTime = Math.min(wanted, video.duration - 0.01);
    }
  };
  fetch(run.film).then((answer) => answer.blob()).then((blob) => {
    video.src = URL.createObjectURL(blob);
  });
  for (const event of ["loadeddata", "seeked"]) video.addEventListener(event, wind);
  player.wind = wind;
  return video;
}

const player = new Player();
const view = element("div", { class: "card view" });
const side = element("div", { class: "side" });
if (run.film) side.append(filmBox(player));
for (const picture of run.pictures) side.append(element("img", { src: picture, alt: t("path", "路线") }));
const curves = element("div", { class: "curves" });

/** All curves, over those of the other run, and by how much they differ in m. */
function showCurves(other) {
  const choose = (time) => player.choose(time);
  player.plots = run.curves.flatMap((curve) => {
    const same = other?.run.curves.find(({ name }) => name[0] === curve.name[0]);
    const differs = same && curve.unit === "m" ? [difference(curve, same)] : [];
    return [plot(curve, language, first, player.last, choose, same),
      ...differs.map((one) => plot(one, language, first, player.last, choose))];
  });
  curves.replaceChildren(...player.plots.map(({ box }) => box));
  player.show(player.time);
}

document.documentElement.lang = language;
document.body.append(
  element("header", {}, element("strong", { text: run.title }), element("span", { class: "grow" }),
    element("button", { id: "language", onclick: switchLanguage,
      text: language === "zh" ? "English" : "中文" })),
  element("main", { class: "replay" },
    element("div", {}, view, element("div", { class: "row player" },
      player.button, player.bar.box, player.text, player.speed),
      comparison(run.title, (other) => { player.compare(other); showCurves(other); }), curves),
    side, ...(run.text ? [element("pre", { class: "card figures", text: run.text })] : [])));
mount(view, player);
showCurves(null);

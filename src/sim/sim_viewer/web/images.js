// The tab of pictures: cameras, other image topics, and windows that scripts open with cv2.imshow.

import { element } from "./dom.js";
import { t } from "./language.js";

export const title = t("Cameras", "相机");

const LOOK_AGAIN_MS = 3000; // for new topics
const COUNTED_MS = 2000; // over which pictures a second are counted
const MOST_PX = 960;
const CHOSEN = "images"; // the topics shown, stored by the browser
const WINDOW = /\/windows\/[^/]+$/; // of a script that calls cv2.imshow
const LOADING = t("loading …", "正在加载……"); // until the first picture

let open = null;

/** One topic's picture, drawn as it comes; `onState(error)` for each, with why there is none. */
export class Picture {
  constructor(topic, link, onState = () => {}) {
    this.topic = topic;
    this._link = link;
    this._onState = onState;
    this._image = element("img", { alt: topic });
    this._rate = element("span", { class: "muted", text: LOADING });
    this._note = element("p", { class: "error", hidden: true });
    this.card = element("figure", { class: "card picture", "data-topic": topic },
      element("figcaption", { class: "row" }, element("b", { text: topic }), this._rate),
      this._image, this._note);
    this._times = [];
  }

  start() {
    const width = Math.min(MOST_PX, Math.max(320, this.card.clientWidth * devicePixelRatio));
    this._stop = this._link.watch("image", { topic: this.topic, width: Math.round(width) },
      (data) => this._show(data), (reason) => this._say(reason));
  }

  stop() {
    this._stop?.();
    this._stop = null;
  }

  /** Pictures a second; 0 when none comes any more. */
  count() {
    const now = performance.now();
    this._times = this._times.filter((time) => now - time < COUNTED_MS);
    const rate = this._times.length / (COUNTED_MS / 1000);
    this.card.dataset.rate = rate;
    this._rate.textContent = this._size ? `${this._size}, ${rate.toFixed(1)} Hz` : LOADING;
  }

  _show(data) {
    if (!(data instanceof DataView)) {
      this._say(data.error);
      return;
    }
    this._note.hidden = true;
    this._onState("");
    this._times.push(performance.now());
    const url = URL.createObjectURL(new Blob([data], { type: "image/jpeg" }));
    this._image.onload = () => {
      URL.revokeObjectURL(url);
      this._size = `${this._image.naturalWidth} × ${this._image.naturalHeight}`;
    };
    this._image.onerror = () => URL.revokeObjectURL(url);
    this._image.src = url;
  }

  _say(reason) {
    this._note.hidden = false;
    this._note.textContent = reason;
    this._onState(reason);
  }
}

class Tab {
  constructor(parent, link) {
    this._link = link;
    this._choice = element("div", { class: "row" });
    this._grid = element("div", { class: "pictures" });
    this._pictures = new Map();
    this._chosen = new Set(JSON.parse(localStorage.getItem(CHOSEN) ?? "[]"));
    parent.append(element("div", { class: "pad" }, this._choice, this._grid));
    this._timers = [setInterval(() => this._look(), LOOK_AGAIN_MS),
      setInterval(() => this._pictures.forEach((picture) => picture.count()), 500)];
    this._onHide = () => this._arrange();
    document.addEventListener("visibilitychange", this._onHide);
    this._look();
  }

  close() {
    this._timers.forEach(clearInterval);
    document.removeEventListener("visibilitychange", this._onHide);
    this._pictures.forEach((picture) => picture.stop());
    this._closed = true;
  }

  async _look() {
    if (document.hidden) return;
    const topics = await this._link.call("image_topics").catch(() => null);
    if (this._closed || topics === null || String(topics) === String(this._topics)) return;
    for (const topic of topics) { // a window is shown when it appears, as on a screen
      if (WINDOW.test(topic) && !this._topics?.includes(topic)) this._chosen.add(topic);
    }
    this._topics = topics;
    if (!topics.some((topic) => this._chosen.has(topic)) && topics.length) {
      this._chosen.add(topics.find((topic) => !topic.includes("depth")) ?? topics[0]);
    }
    this._arrange();
  }

  _choose(topic, wanted) {
    if (wanted) this._chosen.add(topic);
    else this._chosen.delete(topic);
    localStorage.setItem(CHOSEN, JSON.stringify([...this._chosen]));
    this._arrange();
  }

  /** Boxes to tick, and a picture for each that is ticked; none while nobody can see the page. */
  _arrange() {
    const topics = this._topics ?? [];
    this._choice.replaceChildren(...topics.map((topic) => {
      const box = element("input", { type: "checkbox", value: topic,
        onchange: () => this._choose(topic, box.checked) });
      box.checked = this._chosen.has(topic);
      return element("label", {}, box, topic);
    }));
    if (!topics.length) {
      this._choice.append(element("p", { class: "muted", text: t(
        "Nobody publishes pictures. Cameras and windows of cv2.imshow appear here by themselves.",
        "目前没有图像话题。相机和 cv2.imshow 窗口会自动出现在这里。") }));
    }
    const wanted = topics.filter((topic) => this._chosen.has(topic) && !document.hidden);
    for (const [topic, picture] of this._pictures) {
      if (wanted.includes(topic)) continue;
      picture.stop();
      this._pictures.delete(topic);
      if (!document.hidden) picture.card.remove();
    }
    for (const topic of wanted) {
      if (this._pictures.has(topic)) continue;
      const picture = new Picture(topic, this._link);
      this._grid.querySelector(`[data-topic="${CSS.escape(topic)}"]`)?.remove();
      this._grid.append(picture.card);
      picture.start();
      this._pictures.set(topic, picture);
    }
  }
}

export function mount(parent, link) {
  open = new Tab(parent, link);
}

export function unmount() {
  open?.close();
  open = null;
}

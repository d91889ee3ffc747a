// rviz/Image: a picture beside the view, by the tab Cameras' own.

import { Picture } from "../images.js";

const RETRY_MS = 2000; // where nobody publishes the topic yet
const NOTHING = ["Topic", "warning", "No messages received"];

export class ShownPicture {
  constructor(display, link, viewport, onStatus, place) {
    this._picture = new Picture(display.topic, link, (error) => this._tell(error));
    this._place = place;
    this._onStatus = onStatus;
  }

  start() {
    this._place.append(this._picture.card);
    this._onStatus([NOTHING]);
    this._picture.start();
  }

  stop() {
    clearTimeout(this._timer);
    this._picture.stop();
    this._picture.card.remove();
  }

  change() {}

  _tell(error) {
    if (!error) {
      if (!this._fine) this._onStatus([["Image", "ok", "image received"]]);
      this._fine = true;
      return;
    }
    this._fine = false;
    this._onStatus([NOTHING, ["Image", "warning", error]]);
    clearTimeout(this._timer);
    this._timer = setTimeout(() => {
      this._picture.stop();
      this._picture.start();
    }, RETRY_MS);
  }
}

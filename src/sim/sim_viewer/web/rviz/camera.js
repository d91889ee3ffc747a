// rviz/Camera: a camera's picture beside the view, with the scene as the camera sees it.

import { element } from "../dom.js";
import * as THREE from "../vendor/three.module.min.js";
import { place } from "./look.js";
import { Shown } from "./shown.js";

const NEAR = 0.01; // m
const FAR = 400; // m
const WIDTH = 640; // px that are drawn, at most

export class ShownCamera extends Shown {
  constructor(display, link, viewport, onStatus, pictures) {
    super(display, link, viewport, onStatus);
    this._pictures = pictures;
    this._camera = new THREE.PerspectiveCamera();
    this._below = element("img");
    this._above = element("img");
    this.canvas = element("canvas");
    this._layers = element("div", { class: "layers", hidden: true }, this._below, this.canvas,
      this._above);
    this._card = element("figure", { class: "card picture", "data-topic": display.topic },
      element("figcaption", {}, element("b", { text: `${display.name} ${display.topic}` })),
      this._layers);
  }

  start(frame) {
    this._pictures.append(this._card);
    super.start(frame);
  }

  stop() {
    super.stop();
    this._card.remove();
  }

  async _draw([part]) {
    this._layers.hidden = !part;
    if (!part) return;
    const { arrays, rendering, alpha, zoom } = part;
    const url = URL.createObjectURL(new Blob([arrays.jpeg], { type: "image/jpeg" }));
    try {
      for (const image of [this._below, this._above]) image.src = url;
      await Promise.all([this._below.decode(), this._above.decode()]);
    } finally {
      URL.revokeObjectURL(url);
    }
    if (!this._stop) return; // meanwhile
    this._below.style.opacity = rendering.includes("background") ? 1 : 0;
    this._above.style.opacity = rendering.includes("overlay") ? alpha : 0;
    for (const image of [this._below, this._above]) image.style.transform = `scale(${zoom})`;
    this._look(part);
    this.render();
    await new Promise(requestAnimationFrame);
  }

  /** What the camera sees now. */
  render() {
    this._viewport.drawInto(this.canvas, this._camera);
  }

  /** The camera where the picture was taken, with its intrinsics. */
  _look({ pose, size, focal_length: focalLength, principal_point: principalPoint, shift, zoom }) {
    const [width, height] = size;
    const shown = Math.min(width, WIDTH);
    this.canvas.width = shown;
    this.canvas.height = Math.max(1, Math.round(shown * height / width));
    this._layers.style.aspectRatio = `${width} / ${height}`;
    place(this._camera, pose);
    this._camera.translateX(shift[0]).translateY(shift[1]);
    this._camera.rotateX(Math.PI); // a camera's frame looks along z, with y down
    this._camera.projectionMatrix.set(
      2 * zoom * focalLength[0] / width, 0, zoom * (1 - 2 * principalPoint[0] / width), 0,
      0, 2 * zoom * focalLength[1] / height, zoom * (2 * principalPoint[1] / height - 1), 0,
      0, 0, -(FAR + NEAR) / (FAR - NEAR), -2 * FAR * NEAR / (FAR - NEAR),
      0, 0, -1, 0);
    this._camera.projectionMatrixInverse.copy(this._camera.projectionMatrix).invert();
  }
}

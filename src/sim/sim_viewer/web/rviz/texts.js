// Words that face the camera, of a height in m.

import * as THREE from "../vendor/three.module.min.js";

const FONT_PX = 48;
const LINE = 1.25; // heights
const LONGEST_PX = 2048;

/** A sprite of one text; its picture is drawn once. */
function sprite(text, [red, green, blue, alpha]) {
  const lines = text.split("\n");
  const canvas = document.createElement("canvas");
  let pen = canvas.getContext("2d");
  const font = `${FONT_PX}px system-ui, "Noto Sans CJK SC", sans-serif`;
  pen.font = font;
  const width = Math.max(...lines.map((line) => pen.measureText(line).width)) + 8;
  canvas.width = Math.max(1, Math.min(LONGEST_PX, Math.ceil(width)));
  canvas.height = Math.ceil(FONT_PX * LINE * lines.length);
  pen = canvas.getContext("2d");
  pen.font = font;
  pen.textBaseline = "middle";
  pen.textAlign = "center";
  pen.lineJoin = "round";
  pen.lineWidth = 6;
  pen.strokeStyle = `rgba(20, 20, 20, ${0.7 * alpha / 255})`;
  pen.fillStyle = `rgba(${red}, ${green}, ${blue}, ${alpha / 255})`;
  lines.forEach((line, i) => {
    const at = [canvas.width / 2, (i + 0.5) * FONT_PX * LINE];
    pen.strokeText(line, ...at);
    pen.fillText(line, ...at);
  });
  const map = new THREE.CanvasTexture(canvas);
  const made = new THREE.Sprite(new THREE.SpriteMaterial({ map, depthWrite: false }));
  made.raycast = () => {};
  made.name = text;
  return made;
}

export class TextsPart {
  constructor() {
    this.object = new THREE.Group();
    this._sprites = [];
  }

  update({ texts }) {
    const looks = texts.map(({ text, colour }) => JSON.stringify([text, colour]));
    if (String(looks) !== String(this._looks)) {
      this.dispose();
      this._looks = looks;
      this._sprites = texts.map(({ text, colour }) => sprite(text, colour));
      this.object.add(...this._sprites);
    }
    texts.forEach(({ position, height }, i) => {
      const { image } = this._sprites[i].material.map;
      const unit = height / FONT_PX;
      this._sprites[i].position.fromArray(position);
      this._sprites[i].scale.set(image.width * unit, image.height * unit, 1);
    });
  }

  dispose() {
    for (const one of this._sprites) {
      one.removeFromParent();
      one.material.map.dispose();
      one.material.dispose();
    }
    this._sprites = [];
  }
}

// Lines over time on a canvas, scaled to what is seen, with the values under the pointer.

import { element } from "../dom.js";
import { timeText } from "./parts.js";

const MARGIN = { left: 62, right: 12, top: 10, bottom: 26 }; // px
const TICK_PX = { x: 90, y: 44 }; // about as far apart as marks are

/** Round numbers between two bounds, about `count` of them: steps of 1, 2 or 5. */
export function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((one) => one * power >= rough) ?? 10);
  const found = [];
  for (let i = Math.ceil(low / step); i * step <= high + step * 1e-6; i += 1) found.push(i * step);
  return { step, found };
}

/** How many digits behind the point the marks need. */
const digits = (step) => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

function label(value, step) {
  if (Math.max(Math.abs(value), step) >= 1e6 || step < 1e-5) return value.toExponential(2);
  return value.toFixed(digits(step));
}

export class Chart {
  /** `read()` gives `{lines: [{series, colour, visible, path}], span: s, paused}`. */
  constructor(read) {
    this.read = read;
    this.canvas = element("canvas", { class: "chart", id: "plot-chart" });
    this.readout = element("pre", { class: "muted readout" });
    this.pointer = null; // px from the left
    this.waiting = false;
    this.canvas.addEventListener("pointermove", (event) => this.point(event.offsetX));
    this.canvas.addEventListener("pointerleave", () => this.point(null));
  }

  start() {
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.canvas);
  }

  stop() {
    this.observer.disconnect();
  }

  point(x) {
    this.pointer = x;
    this.draw();
  }

  /** Once for all that has come until the next frame. */
  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.paint();
    });
  }

  paint() {
    const ratio = window.devicePixelRatio || 1;
    const [wide, high] = [this.canvas.clientWidth, this.canvas.clientHeight];
    if (!wide || !high) return;
    this.canvas.width = Math.round(wide * ratio);
    this.canvas.height = Math.round(high * ratio);
    const pen = this.canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = "12px system-ui, sans-serif";
    const frame = {
      left: MARGIN.left, top: MARGIN.top,
      right: wide - MARGIN.right, bottom: high - MARGIN.bottom,
    };
    const { lines, span } = this.read();
    const seen = lines.filter((line) => line.visible && line.series.times.length);
    const end = Math.max(...seen.map((line) => line.series.times.at(-1)), 0);
    const scale = this.scale(seen, end - span, end, frame);
    this.paintAxes(pen, frame, scale);
    pen.save();
    pen.beginPath();
    pen.rect(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
    pen.clip();
    seen.forEach((line) => this.paintLine(pen, line, scale));
    pen.restore();
    this.paintPointer(pen, frame, scale, seen);
  }

  /** Functions from time and value to px, and the bounds of both. */
  scale(seen, begin, end, frame) {
    let [low, high] = [Infinity, -Infinity];
    for (const { series } of seen) {
      for (let i = series.from(begin); i < series.values.length; i += 1) {
        const value = series.values[i];
        if (value === null) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (low > high) [low, high] = [0, 1];
    const room = (high - low) * 0.06 || Math.abs(high) * 0.06 || 0.5;
    [low, high] = [low - room, high + room];
    const perSecond = (frame.right - frame.left) / (end - begin);
    const perUnit = (frame.bottom - frame.top) / (high - low);
    return {
      begin, end, low, high,
      x: (time) => frame.left + (time - begin) * perSecond,
      y: (value) => frame.bottom - (value - low) * perUnit,
      time: (x) => begin + (x - frame.left) / perSecond,
    };
  }

  paintAxes(pen, frame, scale) {
    const style = getComputedStyle(this.canvas);
    pen.strokeStyle = style.getPropertyValue("--line");
    pen.fillStyle = style.getPropertyValue("--muted");
    pen.lineWidth = 1;
    const across = ticks(scale.begin, scale.end, (frame.right - frame.left) / TICK_PX.x);
    const up = ticks(scale.low, scale.high, (frame.bottom - frame.top) / TICK_PX.y);
    pen.beginPath();
    pen.textAlign = "center";
    for (const time of across.found) {
      pen.moveTo(scale.x(time), frame.top);
      pen.lineTo(scale.x(time), frame.bottom);
      pen.fillText(timeText(time, digits(across.step)), scale.x(time), frame.bottom + 16);
    }
    pen.textAlign = "right";
    for (const value of up.found) {
      pen.moveTo(frame.left, scale.y(value));
      pen.lineTo(frame.right, scale.y(value));
      pen.fillText(label(value, up.step), frame.left - 6, scale.y(value) + 4);
    }
    pen.stroke();
  }

  paintLine(pen, { series, colour }, scale) {
    pen.strokeStyle = colour;
    pen.lineWidth = 1.6;
    pen.beginPath();
    let down = false;
    for (let i = Math.max(0, series.from(scale.begin) - 1); i < series.times.length; i += 1) {
      const value = series.values[i];
      if (value === null) down = false;
      else {
        const [x, y] = [scale.x(series.times[i]), scale.y(value)];
        if (down) pen.lineTo(x, y);
        else pen.moveTo(x, y);
        down = true;
      }
    }
    pen.stroke();
  }

  paintPointer(pen, frame, scale, seen) {
    const x = this.pointer;
    if (x === null || x < frame.left || x > frame.right || !seen.length) {
      this.readout.textContent = "";
      return;
    }
    pen.strokeStyle = getComputedStyle(this.canvas).getPropertyValue("--muted");
    pen.beginPath();
    pen.moveTo(x, frame.top);
    pen.lineTo(x, frame.bottom);
    pen.stroke();
    const time = scale.time(x);
    this.readout.textContent = [timeText(time, 3), ...seen.map(
      ({ path, series }) => `${path} = ${series.at(time) ?? "–"}`)].join("\n");
  }
}

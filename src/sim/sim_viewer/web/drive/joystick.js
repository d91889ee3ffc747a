// A joystick for finger, pen or mouse: up is forwards, left is left.

import { element } from "../dom.js";

const DEAD_ZONE = 0.1; // of the way to the rim

/** The joystick's element; it drives while a pointer is down on it. */
export function joystick(handle) {
  const knob = element("div", { class: "knob" });
  const pad = element("div", { class: "joystick", id: "joystick" }, knob);
  let pointer = null;

  const move = (event) => {
    if (event.pointerId !== pointer) return;
    const box = pad.getBoundingClientRect();
    const radius = box.width / 2;
    let x = (event.clientX - box.left) / radius - 1;
    let y = (event.clientY - box.top) / radius - 1;
    const far = Math.hypot(x, y);
    if (far > 1) [x, y] = [x / far, y / far];
    knob.style.transform = `translate(${x * radius}px, ${y * radius}px)`;
    handle.hold("joystick", ...(far < DEAD_ZONE ? [0, 0] : [-y, -x]));
  };
  const end = (event) => {
    if (event.pointerId !== pointer) return;
    pointer = null;
    knob.style.transform = "";
    handle.letGo("joystick");
  };

  pad.addEventListener("pointerdown", (event) => {
    if (pointer !== null) return;
    pointer = event.pointerId;
    pad.setPointerCapture(pointer);
    move(event);
  });
  pad.addEventListener("pointermove", move);
  for (const type of ["pointerup", "pointercancel", "lostpointercapture"]) {
    pad.addEventListener(type, end);
  }
  return pad;
}

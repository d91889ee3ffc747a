// Moves and scales an SVG in its box: drag, wheel, and two fingers.

const WHEEL = 1.0015; // scale per wheel unit
const LARGEST = 2.5; // px on the screen for one of the drawing
const READABLE = 0.55; // of the first look, where the whole drawing would be smaller
const TAP_PX = 4; // a drag begins beyond

/**
 * `show(svg, [width, height], first)` puts a drawing into `box`; `fit()` shows all of it. The first
 * time its beginning is shown where the whole would be too small to read.
 */
export function panAndZoom(box) {
  const fingers = new Map(); // pointer id -> [x, y]
  let svg = null;
  let size = [1, 1];
  let place = { x: 0, y: 0, scale: 1 };
  let moved = 0;

  const apply = () => {
    const [wide, high] = [box.clientWidth, box.clientHeight];
    svg?.setAttribute("viewBox", [place.x, place.y, wide / place.scale, high / place.scale]);
  };
  const fit = (smallest = 0) => {
    const [wide, high] = [box.clientWidth || 1, box.clientHeight || 1];
    const scale = Math.max(smallest, Math.min(1.2, wide / size[0], high / size[1]));
    const begin = (length, shown) => Math.min(0, (length - shown / scale) / 2);
    place = { scale, x: begin(size[0], wide), y: begin(size[1], high) };
    apply();
  };
  const zoom = (factor, clientX, clientY) => {
    const frame = box.getBoundingClientRect();
    const [x, y] = [clientX - frame.left, clientY - frame.top];
    const scale = Math.min(LARGEST, Math.max(0.02, place.scale * factor));
    place.x += x / place.scale - x / scale;
    place.y += y / place.scale - y / scale;
    place.scale = scale;
    apply();
  };
  const spread = () => {
    const [[x0, y0], [x1, y1]] = [...fingers.values()];
    return { gap: Math.hypot(x1 - x0, y1 - y0), x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
  };

  box.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(WHEEL ** -event.deltaY, event.clientX, event.clientY);
  }, { passive: false });
  box.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 1) moved = 0;
  });
  box.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const before = fingers.size === 2 ? spread() : null;
    const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    moved += Math.abs(dx) + Math.abs(dy);
    if (moved < TAP_PX) return;
    box.setPointerCapture(event.pointerId);
    place.x -= dx / place.scale / fingers.size;
    place.y -= dy / place.scale / fingers.size;
    if (before) {
      const after = spread();
      if (before.gap > 0) zoom(after.gap / before.gap, after.x, after.y);
    }
    apply();
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"]) {
    box.addEventListener(end, (event) => fingers.delete(event.pointerId));
  }
  // A drag is no tap on what it ended over.
  box.addEventListener("click", (event) => moved >= TAP_PX && event.stopPropagation(), true);
  new ResizeObserver(apply).observe(box);

  return {
    fit: () => fit(),
    show(drawing, itsSize, first) {
      svg = drawing;
      size = itsSize;
      box.replaceChildren(svg);
      if (first) fit(READABLE);
      else apply();
    },
  };
}

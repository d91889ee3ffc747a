// The graph as SVG: nodes are round, topics square; columns and rows come from the server.

import { t } from "../language.js";

const NAMESPACE = "http://www.w3.org/2000/svg";
const FONT = "13px system-ui, sans-serif";
const BOX_PX = 28; // height of a node
const ROW_PX = 42;
const PADDING_PX = 14; // between a name and its border
const GAP_PX = 64; // between columns
const MARGIN_PX = 16;

const pen = document.createElement("canvas").getContext("2d");

/** An SVG element; its text is never markup. */
function shape(tag, attributes, ...children) {
  const made = document.createElementNS(NAMESPACE, tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "text") made.textContent = value;
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

function width(name) {
  pen.font = FONT;
  return pen.measureText(name).width + 2 * PADDING_PX;
}

/** Left edge and width of each column, in px. */
function columnEdges(nodes, count) {
  const widths = Array(count).fill(0);
  for (const node of nodes) widths[node.column] = Math.max(widths[node.column], width(node.name));
  const lefts = [];
  let left = MARGIN_PX;
  for (const one of widths) {
    lefts.push(left);
    left += one + GAP_PX;
  }
  return { lefts, widths, total: left - GAP_PX + MARGIN_PX };
}

const rowY = (row) => MARGIN_PX + BOX_PX / 2 + row * ROW_PX;

/** Where an arrow leaves, passes and enters, as a smooth path. */
function route(edge, from, to, columns, half) {
  const points = [];
  const forward = to.column >= from.column;
  const middle = (column) => columns.lefts[column] + columns.widths[column] / 2;
  edge.points.forEach(([column, row], index) => {
    const y = rowY(row);
    if (index === 0) points.push([middle(column) + (forward ? 1 : -1) * half(from), y]);
    else if (index === edge.points.length - 1) {
      points.push([middle(column) - (forward ? 1 : -1) * half(to), y]);
    } else {
      const sides = [columns.lefts[column], columns.lefts[column] + columns.widths[column]];
      (forward ? sides : sides.reverse()).forEach((x) => points.push([x, y]));
    }
  });
  let path = `M${points[0]}`;
  for (let i = 1; i < points.length; i += 1) {
    const [[x0, y0], [x1, y1]] = [points[i - 1], points[i]];
    const bend = (x1 - x0) / 2;
    path += y0 === y1 ? `L${x1} ${y1}` : `C${x0 + bend} ${y0} ${x1 - bend} ${y1} ${x1} ${y1}`;
  }
  return path;
}

function box(node, columns) {
  const wide = width(node.name);
  const x = columns.lefts[node.column] + (columns.widths[node.column] - wide) / 2;
  const y = rowY(node.row) - BOX_PX / 2;
  return shape("g", { class: node.topic ? "topic" : "node", "data-name": node.name },
    shape("rect", { x, y, width: wide, height: BOX_PX, rx: node.topic ? 3 : BOX_PX / 2 }),
    shape("text", {
      x: x + wide / 2, y: y + BOX_PX / 2, "text-anchor": "middle", "dominant-baseline": "central",
      text: node.name,
    }));
}

function arrowHead() {
  return shape("defs", {}, shape("marker", {
    id: "arrow", viewBox: "0 0 8 8", refX: 8, refY: 4, markerWidth: 8, markerHeight: 8,
    orient: "auto-start-reverse", markerUnits: "userSpaceOnUse",
  }, shape("path", { d: "M0 0L8 4L0 8z", class: "head" })));
}

/**
 * The drawing of `{nodes, edges}`, its size `[width, height]` in px, and a line that counts.
 * A tap on a node or arrow marks what it is connected to, and is described by `tell(text)`.
 */
export function drawGraph({ nodes, edges }, tell) {
  const byId = new Map(nodes.map((node) => [node.id, node]));
  const columns = columnEdges(nodes, 1 + Math.max(-1, ...nodes.map((node) => node.column)));
  const half = (node) => width(node.name) / 2;
  const svg = shape("svg", { class: "graph" }, arrowHead());
  const arrows = edges.filter((edge) => edge.points.length).map((edge) => {
    const path = route(edge, byId.get(edge.from), byId.get(edge.to), columns, half);
    const name = edge.topics.join(", ");
    const arrow = shape("path", {
      d: path, class: "edge", "marker-end": "url(#arrow)",
      "data-from": byId.get(edge.from).name, "data-to": byId.get(edge.to).name,
    }, shape("title", { text: name }));
    return { edge, arrow };
  });
  const boxes = new Map(nodes.map((node) => [node.id, box(node, columns)]));
  const mark = (ids, kept) => {
    svg.classList.toggle("marking", ids.size > 0);
    boxes.forEach((one, id) => one.classList.toggle("marked", ids.has(id)));
    arrows.forEach(({ edge, arrow }) => arrow.classList.toggle("marked", kept(edge)));
  };
  const counted = t(`${nodes.filter((node) => !node.topic).length} nodes, `
    + `${nodes.filter((node) => node.topic).length} topics`,
  `${nodes.filter((node) => !node.topic).length} 个节点，`
    + `${nodes.filter((node) => node.topic).length} 个话题`);
  boxes.forEach((one, id) => one.addEventListener("click", (event) => {
    event.stopPropagation();
    const touching = edges.filter((edge) => edge.from === id || edge.to === id);
    mark(new Set([id, ...touching.flatMap((edge) => [edge.from, edge.to])]),
      (edge) => touching.includes(edge));
    tell(byId.get(id).name);
  }));
  arrows.forEach(({ edge, arrow }) => arrow.addEventListener("click", (event) => {
    event.stopPropagation();
    mark(new Set([edge.from, edge.to]), (one) => one === edge);
    tell(`${byId.get(edge.from).name} → ${byId.get(edge.to).name}: ${edge.topics.join(", ")}`);
  }));
  svg.addEventListener("click", () => {
    mark(new Set(), () => false);
    tell(counted);
  });
  svg.append(...arrows.map(({ arrow }) => arrow), ...boxes.values());
  const bottom = Math.max(0, ...edges.flatMap((edge) => edge.points.map(([, row]) => row)),
    ...nodes.map((node) => node.row));
  return { svg, size: [columns.total, rowY(bottom) + BOX_PX / 2 + MARGIN_PX], describe: counted };
}

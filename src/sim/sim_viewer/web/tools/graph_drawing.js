// The graph as SVG: nodes are round, topics square; places and curves come from the server.

import { t } from "../language.js";

const NAMESPACE = "http://www.w3.org/2000/svg";

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

/** A cubic Bezier curve as an SVG path: a point, then three for each segment. */
const path = ([first, ...others]) => `M${first}C${others.join(" ")}`;

function box(node) {
  const [x, y, width, height] = node.box;
  return shape("g", { class: node.topic ? "topic" : "node", "data-name": node.name },
    shape("rect", {
      x: x - width / 2, y: y - height / 2, width, height, rx: node.topic ? 3 : height / 2,
    }),
    shape("text", {
      x, y, "text-anchor": "middle", "dominant-baseline": "central", text: node.name,
    }));
}

function arrowHead() {
  return shape("defs", {}, shape("marker", {
    id: "arrow", viewBox: "0 0 8 8", refX: 8, refY: 4, markerWidth: 8, markerHeight: 8,
    orient: "auto-start-reverse", markerUnits: "userSpaceOnUse",
  }, shape("path", { d: "M0 0L8 4L0 8z", class: "head" })));
}

/**
 * The drawing of `{size, nodes, edges}`, its size `[width, height]` in px, and a line that counts.
 * A tap on a node or arrow marks what it is connected to, and is described by `tell(text)`.
 */
export function drawGraph({ size, nodes, edges }, tell) {
  const byId = new Map(nodes.map((node) => [node.id, node]));
  const svg = shape("svg", { class: "graph" }, arrowHead());
  const arrows = edges.map((edge) => {
    const name = edge.topics.join(", ");
    const arrow = shape("path", {
      d: path(edge.curve), class: "edge", "marker-end": "url(#arrow)",
      "data-from": byId.get(edge.from).name, "data-to": byId.get(edge.to).name,
    }, shape("title", { text: name }));
    return { edge, arrow };
  });
  const boxes = new Map(nodes.map((node) => [node.id, box(node)]));
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
  return { svg, size, describe: counted };
}

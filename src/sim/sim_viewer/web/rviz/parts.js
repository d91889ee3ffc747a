// The kinds of parts that a display is drawn of: a table from the kind to who draws it.

import { LinksPart } from "./links.js";
import { LinesPart } from "./lines.js";
import { MapPart } from "./map.js";
import { PointsPart } from "./points.js";
import { ShapesPart } from "./shapes.js";
import { TextsPart } from "./texts.js";
import { TrianglesPart } from "./triangles.js";

/** Each is made by `(onChange)`, has `object`, and `update(part)` and `dispose()`. */
export const PARTS = {
  points: PointsPart, lines: LinesPart, triangles: TrianglesPart, shapes: ShapesPart,
  texts: TextsPart, map: MapPart, links: LinksPart,
};

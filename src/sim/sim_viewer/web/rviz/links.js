// Robots and meshes of markers, by the links of the tab 3D.

import { Links } from "../scene/links.js";

export class LinksPart {
  constructor(onChange) {
    this._links = new Links(onChange);
    this.object = this._links.root;
  }

  update({ arrays, ambient, lights, links, alpha = 1 }) {
    const text = JSON.stringify([links, alpha]);
    if (text !== this._text) {
      this._text = text;
      this._links.show({ ambient, lights, links: links.map((link) => faint(link, alpha)) });
      this._links.name(links.map((link) => link.name));
    }
    this._links.move(arrays.rows);
  }

  dispose() {
    this._links.show({ ambient: [1, 1, 1], lights: [], links: [] });
  }
}

function faint(link, alpha) {
  const parts = link.parts.map(({ mesh, material }) => {
    const [red, green, blue, own] = material.diffuse;
    return { mesh, material: { ...material, diffuse: [red, green, blue, own * alpha] } };
  });
  return { ...link, parts };
}

"""Plain solids as triangles, and the three file formats that meshes are written in.

A solid is an array (n, 3, 3): n triangles, three corners each, counter-clockwise seen from outside.
"""

import struct
from itertools import pairwise

import numpy as np

COLLADA = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
  <library_effects>{effects}
  </library_effects>
  <library_materials>{materials}
  </library_materials>
  <library_geometries><geometry id="mesh"><mesh>
    <source id="corners">
      <float_array id="numbers" count="{n_numbers}">{numbers}</float_array>
      <technique_common><accessor source="#numbers" count="{n_corners}" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common>
    </source>
    <vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>{triangles}
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="scene"><node id="node">
    <instance_geometry url="#mesh"><bind_material><technique_common>{bindings}
    </technique_common></bind_material></instance_geometry>
  </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""
PER_MATERIAL = {
    "effects": """
    <effect id="{name}-effect"><profile_COMMON><technique sid="common"><lambert>
      <ambient><color>{rgb} 1</color></ambient><diffuse><color>{rgb} 1</color></diffuse>
    </lambert></technique></profile_COMMON></effect>""",
    "materials": """
    <material id="{name}" name="{name}"><instance_effect url="#{name}-effect"/></material>""",
    "triangles": """
    <triangles material="{name}" count="{count}">
      <input semantic="VERTEX" source="#vertices" offset="0"/><p>{indices}</p>
    </triangles>""",
    "bindings": """
      <instance_material symbol="{name}" target="#{name}"/>""",
}


def prism(outline, low, high, capped=True):
    """A convex outline [(x, y), ...], counter-clockwise, stretched along z from low to high."""
    bottom = np.array([(x, y, low) for x, y in outline], float)
    top = np.array([(x, y, high) for x, y in outline], float)
    triangles = []
    for i in range(len(outline)):
        j = (i + 1) % len(outline)
        triangles += [(bottom[i], bottom[j], top[j]), (bottom[i], top[j], top[i])]
    for i in range(1, len(outline) - 1 if capped else 0):
        triangles += [(top[0], top[i], top[i + 1]), (bottom[0], bottom[i + 1], bottom[i])]
    return np.array(triangles)


def box(x, y, z):
    """x, y, z: (low, high) each."""
    return prism([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])], *z)


def circle(radius, sides, x=0.0, y=0.0):
    angles = 2 * np.pi * np.arange(sides) / sides
    return [(x + radius * np.cos(angle), y + radius * np.sin(angle)) for angle in angles]


def cylinder(radius, z, sides, x=0.0, y=0.0, capped=True):
    return prism(circle(radius, sides, x, y), *z, capped)


def ring(inner, outer, z, sides):
    """A tube along z, with wall from the inner to the outer radius."""
    outside, inside = circle(outer, sides), circle(inner, sides)
    low, high = z
    triangles = []
    for i in range(sides):
        j = (i + 1) % sides
        a, b, c, d = outside[i], outside[j], inside[j], inside[i]
        for (p, q, r, s) in (
            ((*a, low), (*b, low), (*b, high), (*a, high)),
            ((*c, low), (*d, low), (*d, high), (*c, high)),
            ((*a, high), (*b, high), (*c, high), (*d, high)),
            ((*d, low), (*c, low), (*b, low), (*a, low)),
        ):
            triangles += [(p, q, r), (p, r, s)]
    return np.array(triangles, float)


def turned(solid, axes):
    """The solid with its axes renamed, by 0, 1, 2 in an order that does not mirror."""
    return solid[:, :, axes]


def moved(solid, offset):
    return solid + np.asarray(offset, float)


def stl_bytes(solids, digits=4):
    """Binary STL; corners are rounded so that every machine writes the same bytes."""
    solid = np.round(np.concatenate(solids), digits) + 0.0
    across = np.cross(solid[:, 1] - solid[:, 0], solid[:, 2] - solid[:, 0])
    normals = np.round(across / np.linalg.norm(across, axis=1, keepdims=True), 4) + 0.0
    facets = np.concatenate([normals[:, None], solid], axis=1)
    record = np.dtype([("facet", "<f4", (4, 3)), ("attribute", "<u2")])
    records = np.zeros(len(solid), record)
    records["facet"] = facets
    return bytes(80) + struct.pack("<I", len(solid)) + records.tobytes()


def collada_bytes(parts):
    """Collada text of {name: (rgb, solids)}, a material for each name, in metres with z up."""
    filled = dict.fromkeys(PER_MATERIAL, "")
    solid = np.concatenate([each for _, solids in parts.values() for each in solids])
    start = 0
    for name, (rgb, solids) in parts.items():
        count = sum(map(len, solids))
        words = {"name": name, "count": count, "rgb": " ".join(f"{part:g}" for part in rgb),
                 "indices": " ".join(str(i) for i in range(3 * start, 3 * (start + count)))}
        start += count
        for place, template in PER_MATERIAL.items():
            filled[place] += template.format(**words)
    numbers = " ".join(f"{value:g}" for value in np.round(solid, 5).ravel() + 0.0)
    return COLLADA.format(numbers=numbers, n_numbers=solid.size, n_corners=3 * len(solid),
                          **filled).encode()

def obj_text(parts: dict[str, list], library: str) -> str:
    """Wavefront OBJ of {material: faces}, a face a list of corners counter-clockwise from outside.

    Corners are rounded to 0.1 micrometres and listed once; `library` is the file of `mtl_text`.
    """
    numbers, lines = {}, []
    for material, solid in parts.items():
        lines.append(f"usemtl {material}")
        for face in solid:
            corners = [tuple(round(value, 7) + 0.0 for value in corner) for corner in face]
            indices = [numbers.setdefault(corner, len(numbers) + 1) for corner in corners]
            lines += [f"f {indices[0]} {a} {b}" for a, b in pairwise(indices[1:])]
    vertices = ["v " + " ".join(f"{value:.7g}" for value in corner) for corner in numbers]
    return "\n".join([f"mtllib {library}", *vertices, *lines]) + "\n"


def mtl_text(colours: dict[str, tuple[float, float, float]]) -> str:
    """The materials' colours, RGB from 0 to 1."""
    lines = []
    for name, rgb in colours.items():
        colour = " ".join(f"{part:g}" for part in rgb)
        lines += [f"newmtl {name}", f"Ka {colour}", f"Kd {colour}", "Ks 0.05 0.05 0.05", "Ns 10"]
    return "\n".join(lines) + "\n"

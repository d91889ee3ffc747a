"""Writes a URDF link's shapes as SDF elements, so that `<gazebo>` tags can merge into them."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

from bullet_sim.description import Inertial
from bullet_sim.errors import FormatError
from bullet_sim.formats.urdf_tree import read_origin
from bullet_sim.formats.xml_values import not_negative, numbers, vector_text

SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "mesh": ()}
TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

DIAGONAL = ("ixx", "iyy", "izz")  # the products of inertia may be negative


def link_as_sdf(link: Element) -> Element:
    """An SDF `<link>` with the URDF link's shapes; their names are still URDF's, often empty."""
    name = link.get("name", "")
    result = Element("link", {"name": name})
    for tag in ("visual", "collision"):
        for part in link.findall(tag):
            result.append(_part_as_sdf(part, f"link {name!r} <{tag}>"))
    return result


def read_urdf_inertial(link: Element) -> Inertial | None:
    """A link's mass and tensor; None without `<inertial>` or with mass 0."""
    element = link.find("inertial")
    if element is None:
        return None
    where = f"link {link.get('name')!r} <inertial>"
    mass = _attribute(element.find("mass"), "value", f"{where} <mass value>")
    tensor = element.find("inertia")
    values = tuple(_attribute(tensor, key, f"{where} <inertia {key}>") for key in TENSOR)
    not_negative([mass], f"{where} <mass value>")
    for key, value in zip(TENSOR, values, strict=True):
        if key in DIAGONAL:
            not_negative([value], f"{where} <inertia {key}>")
    if mass == 0.0:
        return None
    return Inertial(mass=mass, pose=read_origin(element, where), inertia=values)


def _attribute(element: Element | None, key: str, where: str) -> float:
    if element is None or element.get(key) is None:
        raise FormatError(f"{where} is missing")
    return numbers(element.get(key, ""), 1, where)[0]


def _part_as_sdf(part: Element, where: str) -> Element:
    result = Element(part.tag, {"name": part.get("name", "")})
    origin = part.find("origin")
    if origin is not None:
        read_origin(part, where)  # complains in URDF's terms
        xyz, rpy = origin.get("xyz", "0 0 0"), origin.get("rpy", "0 0 0")
        SubElement(result, "pose").text = f"{xyz} {rpy}"
    result.append(_geometry_as_sdf(part.find("geometry"), where))
    return result


def _geometry_as_sdf(geometry: Element | None, where: str) -> Element:
    shape = None if geometry is None or len(geometry) == 0 else geometry[0]
    if shape is None or shape.tag not in SHAPES:
        written = "nothing" if shape is None else f"<{shape.tag}>"
        raise FormatError(f"{where} <geometry> holds {written}; there are: {', '.join(SHAPES)}")
    result = Element("geometry")
    target = SubElement(result, shape.tag)
    where = f"{where} <{shape.tag}"
    for key in SHAPES[shape.tag]:
        text = shape.get(key)
        if text is None:
            raise FormatError(f"{where} {key}> is missing")
        values = numbers(text, 3 if key == "size" else 1, f"{where} {key}>")
        not_negative(values, f"{where} {key}>")
        SubElement(target, key).text = text
    if shape.tag == "mesh":
        _mesh_as_sdf(shape, target, where)
    return result


def _mesh_as_sdf(shape: Element, target: Element, where: str) -> None:
    if not shape.get("filename"):
        raise FormatError(f"{where} filename> is missing")
    SubElement(target, "uri").text = shape.get("filename")
    scale = numbers(shape.get("scale", "1 1 1"), 3, f"{where} scale>")
    SubElement(target, "scale").text = vector_text(scale)

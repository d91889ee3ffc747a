"""Writes a URDF link's shapes as SDF elements, so that `<gazebo>` tags can be merged into them."""

from dataclasses import replace
from functools import partial
from xml.etree.ElementTree import Element, SubElement

import bullet_sim.formats.xml_values as xml
from bullet_sim.description import Inertial, Material, Visual
from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.mistakes import mistake, reading
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.link import read_link
from bullet_sim.formats.source import Source
from bullet_sim.formats.urdf.tree import read_origin, read_tree
from bullet_sim.formats.xml_values import numbers, parse_xml
from bullet_sim.pose import Pose

RobotLinks = dict[str, tuple[Pose, tuple[Visual, ...]]]


def read_robot_visuals(text: str, resources: Resources) -> tuple[str, RobotLinks]:
    """The robot's name, and its links with their poses at joints zero, relative to the root.

    By URDF's own rules: a simulator drops links without mass and lumps others (lumping.py); to draw
    a robot by its transforms, as rviz does, each link is needed.

    A visual that cannot be read is left out with one warning. FormatError for a text that is not
    URDF.
    """
    robot = parse_xml(text, "the robot description")
    if robot.tag != "robot":
        raise FormatError(f"the robot description is not URDF: its root is <{robot.tag}>")
    tree = read_tree(robot)
    source = Source(resources)
    named = {element.get("name", ""): element for element in robot.findall("material")}
    poses = tree.poses()
    with reading():
        return tree.name, {
            name: (poses[name], tuple(visual for part in link.findall("visual")
                                      for visual in _visuals(name, part, named, source)))
            for name, link in tree.links.items()}


def _visuals(link: str, part: Element, named: dict[str, Element],
             source: Source) -> tuple[Visual, ...]:
    alone = Element("link", {"name": link})
    alone.append(part)
    try:
        visuals = read_link(link_as_sdf(alone), source, "the robot description").visuals
        material = _material(part, named, source)
    except SimulationError as error:
        source.warn_once(f"link {link!r}: a visual is left out: {error}")
        return ()
    return tuple(replace(visual, material=material) for visual in visuals)


def _material(part: Element, named: dict[str, Element], source: Source) -> Material | None:
    """The visual's own material, or the robot's of that name; None: that of the mesh."""
    element = part.find("material")
    if element is None:
        return None
    if element.find("color") is None and element.find("texture") is None:
        element = named.get(element.get("name", ""))
        if element is None:
            return None
    colour, texture = element.find("color"), element.find("texture")
    rgba, path = (1.0, 1.0, 1.0, 1.0), None
    if colour is not None:
        rgba = numbers(colour.get("rgba", ""), 4, "<material> <color rgba>")
    if texture is not None:
        path = str(source.resources.resolve(texture.get("filename", "")))
    return Material(ambient=rgba, diffuse=rgba, texture=path)


SHAPES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "mesh": ()}
TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

DIAGONAL = ("ixx", "iyy", "izz")  # the products of inertia may be negative


def read_urdf_link(link: Element) -> tuple[Element, Inertial | None, FormatError | None]:
    """An SDF `<link>` as from `link_as_sdf`, the result of `read_urdf_inertial`, and the error.

    As in urdfdom's link.cpp, parseLink, an unreadable part is an error line, and it and everything
    after it in the link is left out; inertial, visuals and collisions are read in this order.
    """
    shapes, inertial, wrong = _named_link(link), None, None
    try:
        inertial = read_urdf_inertial(link)
        _add_shapes(shapes, link)
    except FormatError as error:
        wrong = error
        mistake(f"{error}; left out, with the visuals and collisions after it")
    return shapes, inertial, wrong


def link_as_sdf(link: Element) -> Element:
    """An SDF `<link>` with the URDF link's shapes; their names are still URDF's, often empty.

    FormatError for an invalid geometry.
    """
    result = _named_link(link)
    _add_shapes(result, link)
    return result


def _named_link(link: Element) -> Element:
    return Element("link", {"name": link.get("name", "")})


def _add_shapes(result: Element, link: Element) -> None:
    for tag in ("visual", "collision"):
        for part in link.findall(tag):
            result.extend(_part_as_sdf(part, f"link {link.get('name', '')!r} <{tag}>"))


def read_urdf_inertial(link: Element) -> Inertial | None:
    """A link's mass and tensor; None without `<inertial>` or with mass 0.

    FormatError for invalid numbers.
    """
    element = link.find("inertial")
    if element is None:
        return None
    where = f"link {link.get('name')!r} <inertial>"
    mass = _attribute(element.find("mass"), "value", f"{where} <mass value>")
    tensor = element.find("inertia")
    values = tuple(_attribute(tensor, key, f"{where} <inertia {key}>") for key in TENSOR)
    if mass == 0.0:
        return None
    return Inertial(
        mass=_possible(mass, f"{where} <mass value>"),
        pose=read_origin(element, where),
        inertia=tuple(
            _possible(value, f"{where} <inertia {key}>", key in DIAGONAL)
            for key, value in zip(TENSOR, values, strict=True)))


def _possible(value: float, where: str, positive: bool = True) -> float:
    """A mass or moment of inertia; SDF's default, with an error line, if it is impossible."""
    check = xml.not_negative if positive else xml.bounded
    return xml.or_default(partial(check, (value,), where), (float(positive),))[0]


def _attribute(element: Element | None, key: str, where: str) -> float:
    if element is None or element.get(key) is None:
        raise FormatError(f"{where} is missing")
    return xml.numbers(element.get(key, ""), 1, where)[0]


def _part_as_sdf(part: Element, where: str) -> list[Element]:
    """One SDF element; three for a capsule, which SDF 1.7 does not have."""
    place = read_origin(part, where)  # errors in URDF's terms
    shapes = _plain_shapes(part.find("geometry"), where)
    result = []
    for shape, offset in shapes:
        sdf = Element(part.tag, {"name": part.get("name", "")})
        pose = place * Pose((0.0, 0.0, offset))
        SubElement(sdf, "pose").text = xml.vector_text((*pose.position, *pose.rpy()))
        sdf.append(_geometry_as_sdf(shape, where))
        result.append(sdf)
    return result


def _plain_shapes(
    geometry: Element | None, where: str
) -> list[tuple[Element | None, float]]:
    """The shapes that make up a geometry, and the offset of each along z, m."""
    shape = None if geometry is None or len(geometry) == 0 else geometry[0]
    if shape is None or shape.tag != "capsule":
        return [(shape, 0.0)]
    where = f"{where} <capsule"
    length, radius = (
        xml.not_negative([_attribute(shape, key, f"{where} {key}>")], f"{where} {key}>")[0]
        for key in ("length", "radius")
    )
    tube = Element("cylinder", {"radius": repr(radius), "length": repr(length)})
    end = Element("sphere", {"radius": repr(radius)})
    return [(tube, 0.0), (end, length / 2), (end, -length / 2)]


def _geometry_as_sdf(shape: Element | None, where: str) -> Element:
    if shape is None or shape.tag not in SHAPES:
        written = "nothing" if shape is None else f"<{shape.tag}>"
        raise FormatError(f"{where} <geometry> holds {written}; there are: "
                          f"{', '.join(SHAPES)}, capsule")
    result = Element("geometry")
    target = SubElement(result, shape.tag)
    where = f"{where} <{shape.tag}"
    for key in SHAPES[shape.tag]:
        text = shape.get(key)
        if text is None:
            raise FormatError(f"{where} {key}> is missing")
        xml.numbers(text, 3 if key == "size" else 1, f"{where} {key}>")
        SubElement(target, key).text = text
    if shape.tag == "mesh":
        _mesh_as_sdf(shape, target, where)
    return result


def _mesh_as_sdf(shape: Element, target: Element, where: str) -> None:
    if not shape.get("filename"):
        raise FormatError(f"{where} filename> is missing")
    SubElement(target, "uri").text = shape.get("filename")
    scale = xml.numbers(shape.get("scale", "1 1 1"), 3, f"{where} scale>")
    SubElement(target, "scale").text = xml.vector_text(scale)

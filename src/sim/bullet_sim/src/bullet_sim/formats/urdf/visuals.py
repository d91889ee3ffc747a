"""The look of a URDF robot, by URDF's own rules: every link stays, and colours are the URDF's.

A simulator drops links without mass and lumps others (`urdf/lumping.py`); to draw a robot by its
transforms, as rviz does, each link is needed.
"""

from dataclasses import replace
from xml.etree.ElementTree import Element

from bullet_sim.description import Material, Visual
from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.mistakes import reading
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.link import read_link
from bullet_sim.formats.source import Source
from bullet_sim.formats.urdf.link import link_as_sdf
from bullet_sim.formats.urdf.tree import read_tree
from bullet_sim.formats.xml_values import numbers, parse_xml
from bullet_sim.pose import Pose

RobotLinks = dict[str, tuple[Pose, tuple[Visual, ...]]]


def read_robot_visuals(text: str, resources: Resources) -> tuple[str, RobotLinks]:
    """The robot's name, and its links with their poses at joints zero, relative to the root.

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

"""Converts the `<gazebo>` tags of a URDF's links and joints to SDF elements."""

import copy
from collections.abc import Iterator
from xml.etree.ElementTree import Element, SubElement

from bullet_sim.formats.mistakes import or_without
from bullet_sim.formats.xml_values import not_negative, numbers

SURFACE_PATHS = {
    "mu1": "surface/friction/ode/mu",
    "mu2": "surface/friction/ode/mu2",
    "fdir1": "surface/friction/ode/fdir1",
    "kp": "surface/contact/ode/kp",
    "kd": "surface/contact/ode/kd",
    "maxVel": "surface/contact/ode/max_vel",
    "minDepth": "surface/contact/ode/min_depth",
    "maxContacts": "max_contacts",
    "laserRetro": "laser_retro",
}
CONTAINERS = ("material", "surface", "friction", "contact", "ode", "bounce", "torsional")
TRUE_WORDS = ("true", "yes", "1")
FALSE_WORDS = ("false", "no", "0")


class Extensions:
    """The children of all `<gazebo>` elements by their reference; blocks accumulate."""

    def __init__(self, robot: Element):
        self._by_reference: dict[str, list[Element]] = {}
        for block in robot.findall("gazebo"):
            self._by_reference.setdefault(block.get("reference", ""), []).extend(block)

    def of(self, reference: str) -> list[Element]:
        """All extensions of a link or joint, or with "" of the robot."""
        return self._by_reference.get(reference, [])

    def references(self) -> Iterator[str]:
        """The names in references."""
        return (name for name in self._by_reference if name)

    def says(self, reference: str, tag: str) -> bool:
        """Whether the last such tag is true."""
        values = [value_of(child) for child in self.of(reference) if child.tag == tag]
        return bool(values) and is_true(values[-1])


def value_of(element: Element) -> str:
    """An extension's value: the attribute `value` of older files, or its text."""
    return (element.get("value") or element.text or "").strip()


def is_true(text: str) -> bool:
    """Whether a text is true, as in robot-level tags."""
    return text.lower() in TRUE_WORDS


def extend_link(link: Element, tags: list[Element], lumped: bool) -> None:
    """Add a link's extensions to its SDF element.

    After lumping a child's shapes are only known by name: those whose own URDF name does not
    contain the link's name get nothing.
    """
    name = link.get("name", "")
    for tag in tags:
        targets = _targets(tag)
        if targets is None:
            _extend_link_itself(link, tag)
            continue
        for part in link.findall(targets):
            own_name = part.get("name", "")
            if not (lumped and own_name and name not in own_name):
                _extend_part(part, tag, name)


def _targets(tag: Element) -> str | None:
    """The tag of the parts of the link that a tag applies to; None for the link itself."""
    if tag.tag in ("material", "visual"):
        return "visual"
    if tag.tag == "collision" or tag.tag in SURFACE_PATHS:
        return "collision"
    return None


def _extend_part(part: Element, tag: Element, link: str) -> None:
    if tag.tag == "material":
        _set_material(part, tag)
    elif tag.tag in SURFACE_PATHS:
        count = 3 if tag.tag == "fdir1" else 1
        where = f"<gazebo reference={link!r}> <{tag.tag}>"
        if or_without(numbers, value_of(tag), count, where) is not None:
            put(part, SURFACE_PATHS[tag.tag], value_of(tag))
    else:
        for child in tag:
            merge(part, child)


def _set_material(visual: Element, tag: Element) -> None:
    if len(tag):
        merge(visual, tag)
        return
    put(visual, "material/script/name", value_of(tag))


def _extend_link_itself(link: Element, tag: Element) -> None:
    value = value_of(tag)
    if tag.tag == "selfCollide":
        put(link, "self_collide", str(is_true(value)).lower())
    elif tag.tag == "turnGravityOff":
        put(link, "gravity", str(value.lower() in FALSE_WORDS).lower())
    elif tag.tag == "dampingFactor":
        where = f"<gazebo reference={link.get('name')!r}> <dampingFactor>"
        if or_without(lambda: not_negative(numbers(value, 1, where), where)) is not None:
            put(link, "velocity_decay/linear", value)
            put(link, "velocity_decay/angular", value)
    else:
        link.append(copy.deepcopy(tag))


def put(element: Element, path: str, value: str) -> None:
    """Set the text at a path, creating missing elements."""
    for tag in path.split("/"):
        child = element.find(tag)
        element = child if child is not None else SubElement(element, tag)
    element.text = value


def merge(element: Element, addition: Element) -> None:
    """Add a child; if both have a container of that tag, their children are merged."""
    there = element.find(addition.tag) if addition.tag in CONTAINERS else None
    if there is None:
        element.append(copy.deepcopy(addition))
        return
    for child in addition:
        merge(there, child)

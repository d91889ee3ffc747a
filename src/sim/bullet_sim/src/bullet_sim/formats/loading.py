"""Reads a model, light or world from text: URDF or SDF, by the root element."""

import re
from collections import Counter
from dataclasses import replace
from pathlib import Path
from xml.etree.ElementTree import Element

from bullet_sim.description import LightDescription, ModelDescription, WorldDescription
from bullet_sim.errors import FormatError, ResourceNotFound
from bullet_sim.formats.mistakes import reading
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.sdf.include import read_include
from bullet_sim.formats.sdf.model import read_model
from bullet_sim.formats.sdf.scene import read_light
from bullet_sim.formats.sdf.unknown_elements import warn_of_unknown_elements
from bullet_sim.formats.sdf.world import read_world
from bullet_sim.formats.source import Source
from bullet_sim.formats.urdf.robot import read_robot
from bullet_sim.formats.xml_values import parse_xml, read_xml_file
from bullet_sim.pose import IDENTITY

NOT_A_MODEL = (
    "GazeboRosApiPlugin SpawnModel Failure: input model_xml not SDF or URDF, or cannot be "
    "converted to Gazebo compatible format."
)
SDF_ROOTS = ("sdf", "gazebo")
PACKAGE_URI = re.compile(r"package://([^/\\\s\"'<>]+)")


# Of one text. Each link without a joint is a body of the engine, and takes some ms to make; a world
# of that many is far from real time.
MOST = {"model": 5000, "link": 5000, "joint": 5000, "sensor": 2000, "plugin": 2000,
        "light": 2000, "visual": 50_000, "collision": 50_000}


def load_model(text: str, resources: Resources, name: str | None = None) -> ModelDescription:
    """The model in a URDF or SDF text; `name` replaces the one in the text.

    FormatError for a text that is neither, and for errors in it that cannot be skipped.
    """
    return _model_in(_parse_model(text), resources, name)


def load_entity(text: str, resources: Resources, name: str | None = None
                ) -> ModelDescription | LightDescription:
    """The light in an SDF text whose root's first child is one; of other texts the model.

    FormatError as `load_model`.
    """
    root = _parse_model(text)
    if root.tag not in SDF_ROOTS or len(root) == 0 or root[0].tag != "light":
        return _model_in(root, resources, name)
    with reading():
        light = read_light(root[0])
    return replace(light, name=name) if name else light


def load_world(path: Path | str, resources: Resources) -> WorldDescription:
    """The first world of a file; `Resources.find_world` finds the file.

    FormatError if the file is not XML or has no `<world>`; any other error in it is an error line,
    and the rest is read. ResourceNotFound if there is no file.
    """
    path = Path(path)
    if not path.is_file():
        raise ResourceNotFound(f"world file {path}", [str(path.parent)],
                               [other.name for other in path.parent.glob("*.world")])
    root = read_xml_file(path)
    world = root.find("world") if root.tag in SDF_ROOTS else None
    if world is None:
        raise FormatError(f"{path} has no <world> in an <sdf> root (the root is <{root.tag}>)")
    _check_size(root, str(path))
    source = Source(resources, _read_root).entering(path.resolve()).of_root(root)
    warn_of_unknown_elements(root, source, str(path))
    with reading(str(path)):
        return read_world(world, source)


def _parse_model(text: str) -> Element:
    try:
        return parse_xml(text, "the text")
    except FormatError as error:
        raise FormatError(f"{NOT_A_MODEL} ({error})") from None


def _model_in(root: Element, resources: Resources, name: str | None) -> ModelDescription:
    _check_size(root, "the text")
    named = root
    if root.tag == "robot":
        _refuse_unprocessed(root)
        _put_in_package_folders(root, resources)
    elif root.tag in SDF_ROOTS:
        named = _model_of(root)
    else:
        raise FormatError(f"{NOT_A_MODEL} (the root element is <{root.tag}>)")
    if name and named is not None:
        named.set("name", name)
    with reading():
        model = _read_root(root, Source(resources, _read_root))
    return replace(model, name=name) if name else model


def _refuse_unprocessed(root: Element) -> None:
    """Raises FormatError for a xacro file as it is: its ${} are no numbers, its macros no links."""
    tags = {each.tag for each in root.iter() if each.tag.startswith("xacro:")}
    if tags and any("${" in value for each in root.iter() for value in each.attrib.values()):
        raise FormatError(f"robot '{root.get('name', '')}' has xacro's tags in it, such as "
                          f"<{min(tags)}>; run xacro first: rosrun xacro xacro FILE")


def _check_size(root: Element, what: str) -> None:
    counts = Counter(element.tag for element in root.iter())
    for tag, most in MOST.items():
        if counts[tag] > most:
            raise FormatError(f"{what} has {counts[tag]} elements <{tag}>; at most {most} can be "
                              "simulated; split it, or keep what the robot meets")


def _put_in_package_folders(root: Element, resources: Resources) -> None:
    """Replace `package://NAME` by the package's folder, as the URDF spawn service does."""
    def folder(match: re.Match) -> str:
        try:
            return str(resources.package_folder(match[1]))
        except ResourceNotFound as error:
            raise FormatError(
                f"urdf reference package name does not exist: {match[1]}"
            ) from error

    for element in root.iter():
        for key, value in element.items():
            if "package://" in value:
                element.set(key, PACKAGE_URI.sub(folder, value))
        if element.text and "package://" in element.text:
            element.text = PACKAGE_URI.sub(folder, element.text)


def _read_root(root: Element, source: Source) -> ModelDescription:
    if root.tag == "robot":
        return read_robot(root, source)
    source = source.of_root(root)
    warn_of_unknown_elements(root, source, str(source.including[-1]) if source.including else "")
    model = _model_of(root)
    if model is not None:
        return read_model(model, source)
    # sent by spawn_model -database: a world that only includes the model
    include = root.find("world/include")
    if include is None:
        raise FormatError(f"no <model> in the <{root.tag}> text")
    found = read_include(include, source)
    if not isinstance(found, ModelDescription):
        uri = (include.findtext("uri") or "").strip()
        source.resources.resolve(uri)
        raise FormatError(f"<include> of {uri!r} contains no model")
    # The service writes a <pose> into the include, which replaces the model's own.
    return found if include.find("pose") is not None else replace(found, pose=IDENTITY)


def _model_of(root: Element) -> Element | None:
    """The only model of an SDF text."""
    model = root.find("model")
    return root.find("world/model") if model is None else model

"""Shapes for meshes of Gazebo's own models, which saved worlds name and which are not here.

Gazebo's window saves a model with its meshes, not as an `<include>`. Our model of the same name is
made of plain shapes, and they are taken for the mesh, as much larger as it is scaled.
"""

import logging
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeVar
from xml.etree.ElementTree import Element

from bullet_sim.description import Collision, Visual
from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.prop_meshes import prop_mesh
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import child_text, pose, read_xml_file, vector
from bullet_sim.pose import Vector3

logger = logging.getLogger(__name__)

Part = TypeVar("Part", Visual, Collision)
Reader = Callable[[Element, Source, str], "Part | None"]

MODEL_FILE = re.compile(r"(?:^model://|/\.gazebo/models/)([^/]+)/.")
TAKEN = ("geometry", "material", "pose")
ONES = (1.0, 1.0, 1.0)


def read_parts(
    read: Reader, element: Element, source: Source, link: str, name: str
) -> list[Part]:
    """What `read` makes of a `<visual>` or `<collision>`: mostly one part, at times none.

    `link` is how errors call the link, `name` is its own.

    A missing mesh of a model that we have is that model's own visuals, or collisions. They keep
    their colours; what else is written of the part holds for all of them.

    FormatError of a shape that cannot be.
    """
    file = _prop_of(element, source)
    if file is None:
        part = read(element, source, link)
        return [] if part is None else [part]
    key = f"mesh of {file.parent.name}"
    if key not in source.warned:
        source.warned.add(key)
        logger.info("%s: %s is not here; the plain shapes of model://%s are taken", link,
                    child_text(element, "geometry/mesh/uri"), file.parent.name)
    inside = source.entering(file)
    mesh = prop_mesh(file.parent.name)
    origin, scale = pose(element, link), _scale(element)
    parts = []
    for written in _parts_of(file, element, name):
        part = read(written, inside, link)
        if part is not None:
            place, shape = mesh.placed(scale, part.pose, part.geometry)
            parts.append(replace(part, pose=origin * place, geometry=shape))
    return parts


def _scale(element: Element) -> Vector3:
    return vector(element, "geometry/mesh/scale", ONES, child_text(element, "geometry/mesh/uri"))


def _prop_of(element: Element, source: Source) -> Path | None:
    """The model file whose shapes replace the mesh, if there is one."""
    uri = child_text(element, "geometry/mesh/uri")
    named = MODEL_FILE.search(uri)
    if named is None or 0.0 in _scale(element):
        return None
    try:
        source.resources.resolve(uri, source.folder)
    except ResourceNotFound:
        file = DATA_FOLDER / "models" / named[1] / "model.sdf"
        return file if file.is_file() else None
    return None


def _parts_of(file: Path, written: Element, name: str) -> Iterator[Element]:
    """The parts of the model's link of that `name`, or of its first, with all that is written of
    the mesh's; their poses are those in that link."""
    links = read_xml_file(file).findall("model/link")
    link = next((link for link in links if link.get("name") == name), links[0])
    for part in link.findall(written.tag):
        made = Element(written.tag, name=f"{written.get('name')}_{part.get('name')}")
        made.extend(child for child in written if child.tag not in TAKEN)
        made.extend(child for child in part if child.tag in TAKEN)
        yield made

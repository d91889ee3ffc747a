"""Shapes for meshes of Gazebo's own models, which saved worlds name and which are not here.

Gazebo's window saves a model with its meshes, not as an `<include>`. Our model of the same name is
made of plain shapes, and they are taken for the mesh.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeVar
from xml.etree.ElementTree import Element

from bullet_sim.description import Collision, Visual
from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import child_text, pose, read_xml_file, vector
from bullet_sim.pose import Pose

logger = logging.getLogger(__name__)

Part = TypeVar("Part", Visual, Collision)
Reader = Callable[[Element, Source, str], "Part | None"]

MODEL_FILE = re.compile(r"(?:^model://|/\.gazebo/models/)([^/]+)/.")
TAKEN = ("geometry", "material")
ONES = (1.0, 1.0, 1.0)


def read_parts(read: Reader, element: Element, source: Source, link: str) -> list[Part]:
    """What `read` makes of a `<visual>` or `<collision>`: mostly one part, at times none.

    A missing mesh of a model that we have is that model's own visuals, or collisions. They keep
    their colours; what else is written of the part holds for all of them.
    """
    file = _prop_of(element, source)
    if file is None:
        part = read(element, source, link)
        return [] if part is None else [part]
    key = f"mesh of {file.parent.name}"
    if key not in source.said:
        source.said.add(key)
        logger.info("%s: %s is not here; the plain shapes of model://%s are taken", link,
                    child_text(element, "geometry/mesh/uri"), file.parent.name)
    inside = source.entering(file)
    made = [(place, read(part, inside, link)) for place, part in _parts_of(file, element)]
    return [replace(part, pose=place) for place, part in made if part is not None]


def _prop_of(element: Element, source: Source) -> Path | None:
    """The model file whose shapes are to stand for the mesh, if they are."""
    uri = child_text(element, "geometry/mesh/uri")
    named = MODEL_FILE.search(uri)
    if named is None or vector(element, "geometry/mesh/scale", ONES, uri) != ONES:
        return None
    try:
        source.resources.resolve(uri, source.folder)
    except ResourceNotFound:
        file = DATA_FOLDER / "models" / named[1] / "model.sdf"
        return file if file.is_file() else None
    return None


def _parts_of(file: Path, written: Element) -> Iterator[tuple[Pose, Element]]:
    """The model's parts with all that is written of the mesh's, and where they are in the link."""
    where = file.parent.name
    for link in read_xml_file(file).iterfind("model/link"):
        for part in link.findall(written.tag):
            made = Element(written.tag, name=f"{written.get('name')}_{part.get('name')}")
            made.extend(child for child in written if child.tag not in TAKEN)
            made.extend(child for child in part if child.tag in TAKEN)
            yield pose(written, where) * pose(link, where) * pose(part, where), made

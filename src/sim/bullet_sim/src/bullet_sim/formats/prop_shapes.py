"""Shapes in place of meshes of Gazebo's own models, which saved worlds name but are not here.

Gazebo's client saves a model with its meshes, not as an `<include>`. Our model of the same name is
made of plain shapes, which replace the mesh, scaled in the same way.
"""

import functools
import logging
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar
from xml.etree.ElementTree import Element

from bullet_sim.description import Collision, Geometry, Visual
from bullet_sim.errors import FormatError, ResourceNotFound
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.sdf.shapes import scaled
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import child_text, pose, read_xml_file, vector
from bullet_sim.pose import IDENTITY, Pose, Vector3, rotate

logger = logging.getLogger(__name__)

Part = TypeVar("Part", Visual, Collision)
Reader = Callable[[Element, Source, str], "Part | None"]

MODEL_FILE = re.compile(r"(?:^model://|/\.gazebo/models/)([^/]+)/.")
TAKEN = ("geometry", "material", "pose")
ONES = (1.0, 1.0, 1.0)


def read_parts(
    read: Reader, element: Element, source: Source, link: str, name: str
) -> list[Part]:
    """The results of `read` for a `<visual>` or `<collision>`: usually one part, sometimes none.

    `link` is the link in error messages, `name` its name.

    A missing mesh of a model that we have is replaced by that model's visuals, or collisions.
    They keep their colours; everything else written for the part applies to all of them.

    FormatError for an impossible shape.
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
    """The parts of the model's link with that `name`, or of its first link, with everything that is
    written for the mesh; their poses are in that link."""
    links = read_xml_file(file).findall("model/link")
    link = next((link for link in links if link.get("name") == name), links[0])
    for part in link.findall(written.tag):
        made = Element(written.tag, name=f"{written.get('name')}_{part.get('name')}")
        made.extend(child for child in written if child.tag not in TAKEN)
        made.extend(child for child in part if child.tag in TAKEN)
        yield made


FILE = DATA_FOLDER / "prop_meshes.toml"
AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
COUNTS = {"scale": (3,), "at": (3, 6)}  # allowed counts of numbers by key


@dataclass(frozen=True)
class PropMesh:
    """How the mesh is placed in the model's own file."""

    scale: Vector3 = (1.0, 1.0, 1.0)  # the scale at which the mesh is as large as our shapes
    at: Pose = IDENTITY  # its origin in the link of our shapes

    def placed(self, scale: Vector3, part: Pose, shape: Geometry) -> tuple[Pose, Geometry]:
        """Pose from the mesh's origin, and shape, of one of our parts for a mesh with `<scale>`.

        `part` is the part's pose in our link.
        """
        factors = tuple(new / own for new, own in zip(scale, self.scale, strict=True))
        pose = self.at.inverse() * part
        return _mirrored(pose, factors), scaled(shape, _along(pose, factors))


def _mirrored(pose: Pose, factors: Vector3) -> Pose:
    x, y, z, w = pose.orientation
    a, b, c = (-1.0 if factor < 0 else 1.0 for factor in factors)
    position = tuple(f * value for f, value in zip(factors, pose.position, strict=True))
    return Pose(position, (b * c * x, a * c * y, a * b * z, w))


def _along(pose: Pose, factors: Vector3) -> Vector3:
    """Scale factors along the axes of a part when the mesh is scaled along its own axes."""
    return tuple(
        sum((factor * value) ** 2 for factor, value in
            zip(factors, rotate(pose.orientation, axis), strict=True)) ** 0.5
        for axis in AXES)


def prop_mesh(folder: str) -> PropMesh:
    """The one of a folder of data/models. FormatError if our own table is wrong."""
    return read_prop_meshes(FILE).get(folder, PropMesh())


@functools.cache
def read_prop_meshes(file: Path) -> dict[str, PropMesh]:
    """The file's tables. FormatError for an unknown key, a wrong count or a scale of 0."""
    tables = tomllib.loads(file.read_text(encoding="utf-8"))
    return {name: _mesh(f"{file}: [{name}]", table) for name, table in tables.items()}


def _mesh(where: str, table: dict) -> PropMesh:
    for key, values in table.items():
        if key not in COUNTS:
            raise FormatError(f"{where} has an unknown key {key!r}; there are: {', '.join(COUNTS)}")
        if not _numbers(values, COUNTS[key]) or (key == "scale" and 0 in values):
            counts = " or ".join(map(str, COUNTS[key]))
            raise FormatError(f"{where} {key} = {values!r} is not {counts} numbers"
                              f"{' other than 0' if key == 'scale' else ''}")
    at = [float(value) for value in table.get("at", (0, 0, 0))]
    return PropMesh(tuple(float(value) for value in table.get("scale", (1, 1, 1))),
                    Pose.from_xyz_rpy(at[:3], at[3:] or (0.0, 0.0, 0.0)))


def _numbers(values: object, counts: Iterable[int]) -> bool:
    return (isinstance(values, list) and len(values) in counts
            and all(isinstance(value, int | float) for value in values))

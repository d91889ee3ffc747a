"""Meshes of Gazebo's model library that shapes of data/models replace: their sizes and places."""

import functools
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bullet_sim.description import Geometry
from bullet_sim.errors import FormatError
from bullet_sim.formats.resources import DATA_FOLDER
from bullet_sim.formats.sdf.scale import scaled
from bullet_sim.pose import IDENTITY, Pose, Vector3, rotate

FILE = DATA_FOLDER / "prop_meshes.toml"
AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
COUNTS = {"scale": (3,), "at": (3, 6)}  # numbers of each key


@dataclass(frozen=True)
class PropMesh:
    """What a model's own file writes of its mesh."""

    scale: Vector3 = (1.0, 1.0, 1.0)  # with which it is as large as our shapes
    at: Pose = IDENTITY  # its origin in the link of our shapes

    def placed(self, scale: Vector3, part: Pose, shape: Geometry) -> tuple[Pose, Geometry]:
        """A part of ours as that of the mesh at another `<scale>`: pose from the mesh's origin.

        `part` is its pose in our link.
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
    """How much longer each axis of a part becomes when the mesh is scaled along its own."""
    return tuple(
        sum((factor * value) ** 2 for factor, value in
            zip(factors, rotate(pose.orientation, axis), strict=True)) ** 0.5
        for axis in AXES)


def prop_mesh(folder: str) -> PropMesh:
    """That of a folder of data/models. FormatError if our own table is wrong."""
    return read_prop_meshes(FILE).get(folder, PropMesh())


@functools.cache
def read_prop_meshes(file: Path) -> dict[str, PropMesh]:
    """The file's tables. FormatError for an unknown key, a wrong count, a scale of 0."""
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

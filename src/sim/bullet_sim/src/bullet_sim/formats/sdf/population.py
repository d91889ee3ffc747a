"""Reads `<population>`: copies of one model, distributed over a box or a cylinder.

The copies' positions depend only on the population's name: each run has the same world.
"""

import math
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace
from xml.etree.ElementTree import Element

import numpy as np

from bullet_sim.description import ModelDescription
from bullet_sim.errors import FormatError
from bullet_sim.formats.sdf.model import read_model
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import amount, child_text, integer, pose, vector
from bullet_sim.pose import Pose, Vector3

MOST_MODELS = 1000
CANDIDATES = 20  # tried for each position of a uniform distribution
DISTRIBUTIONS = ("random", "uniform", "grid", "linear-x", "linear-y", "linear-z")


def read_population(element: Element, source: Source) -> list[ModelDescription]:
    """The copies, named `NAME_clone_0` and so on.

    FormatError if there is no <model>, and for an unknown distribution.
    """
    name = element.get("name", "")
    where = f"population {name!r}"
    model = element.find("model")
    if model is None:
        raise FormatError(f"{where}: no <model> to copy")
    original = read_model(model, source)
    region = pose(element, where)
    return [
        replace(original, name=f"{original.name}_clone_{number}",
                pose=region * Pose(place) * original.pose)
        for number, place in enumerate(_places(element, name, where))
    ]


def _places(element: Element, name: str, where: str) -> list[Vector3]:
    """Positions in the population's own frame, m."""
    kind = child_text(element, "distribution/type", "random")
    if kind not in DISTRIBUTIONS:
        raise FormatError(f"{where} <distribution>: no type {kind!r}; there are: "
                          f"{', '.join(DISTRIBUTIONS)}")
    if kind == "grid":
        return list(_grid(element, f"{where} <distribution>"))
    count = _limited(integer(element, "model_count", 1, where), where)
    size, inside = _region(element, where)
    if kind.startswith("linear"):
        axis = "xyz".index(kind[-1])
        steps = np.linspace(-0.5, 0.5, count) if count > 1 else [0.0]
        return [tuple(size[axis] * step if i == axis else 0.0 for i in range(3))
                for step in steps]
    random = np.random.default_rng(zlib.crc32(name.encode()))
    tries = CANDIDATES if kind == "uniform" else 1
    places = np.empty((count, 3))
    for number in range(count):
        drawn = np.array([_drawn(random, size, inside) for _ in range(tries)])
        gaps = np.linalg.norm(drawn[:, None] - places[:number], axis=2)
        places[number] = drawn[gaps.min(axis=1, initial=math.inf).argmax()]
    return [tuple(place) for place in places.tolist()]


def _grid(element: Element, where: str) -> Iterator[Vector3]:
    """Rows along x, columns along y, around the centre."""
    rows = _limited(integer(element, "distribution/rows", 1, where), where)
    columns = _limited(integer(element, "distribution/cols", 1, where), where)
    _limited(rows * columns, where)
    step = vector(element, "distribution/step", (0.5, 0.5, 0.0), where)
    for row in range(rows):
        for column in range(columns):
            yield ((row - (rows - 1) / 2) * step[0], (column - (columns - 1) / 2) * step[1], 0.0)


def _limited(count: int, where: str) -> int:
    if not 0 <= count <= MOST_MODELS:
        raise FormatError(f"{where}: {count} models are not possible; 0 to {MOST_MODELS} are")
    return count


def _region(element: Element, where: str) -> tuple[Vector3, Callable[[np.ndarray], bool]]:
    """Lengths of the region's bounding box, and the test for points inside the region."""
    cylinder = element.find("cylinder")
    if cylinder is None:
        return vector(element, "box/size", (1.0, 1.0, 1.0), f"{where} <box>"), lambda place: True
    radius = amount(cylinder, "radius", 1.0, f"{where} <cylinder>")
    length = amount(cylinder, "length", 1.0, f"{where} <cylinder>")
    return (2 * radius, 2 * radius, length), lambda place: math.hypot(*place[:2]) <= radius


def _drawn(random: np.random.Generator, size: Vector3,
           inside: Callable[[np.ndarray], bool]) -> np.ndarray:
    while True:
        place = random.uniform(-0.5, 0.5, 3) * size
        if inside(place):
            return place

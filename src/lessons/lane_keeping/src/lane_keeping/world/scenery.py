"""The YAML files about the lane: zebra crossings, trees, lamps, and the sun's direction."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from pathlib import Path

import rospkg

from lane_keeping.settings import SettingsError, read_table

PERSON_RADIUS = 0.12  # m, of the collision shape


@dataclass(frozen=True)
class Zebra:
    """A crossing's centre, m, and the lane's heading there, rad."""

    x: float
    y: float
    heading: float


@dataclass(frozen=True)
class Crossings:
    """crossings.yaml of lane_keeping, key by key; m."""

    length: float  # along the road
    half_width: float
    kerb: float  # from the lane's middle
    far: float
    zebras: tuple[Zebra, ...]


@dataclass(frozen=True)
class Tree:
    """Place, radius of the crown, height of the crown's centre; m."""

    x: float
    y: float
    crown: float
    height: float


@dataclass(frozen=True)
class Lamp:
    """Place and height; m."""

    x: float
    y: float
    height: float


@dataclass(frozen=True)
class Scenery:
    """lane_scenery.yaml, key by key."""

    sun: tuple[float, float, float]  # direction of its light
    shade: float  # share of the light that remains in the shade
    trees: tuple[Tree, ...]
    lamps: tuple[Lamp, ...]

    def shadow_of(self, x: float, y: float, height: float) -> tuple[float, float]:
        """Where the shade of a point at this height (m) falls on the ground."""
        return x - self.sun[0] / self.sun[2] * height, y - self.sun[1] / self.sun[2] * height


def load_crossings(path: Path | None = None) -> Crossings:
    """From the package's own file, or another one; SettingsError names file and key."""
    path = path or config_folder() / "crossings.yaml"
    values = _read_keys(path, [field.name for field in fields(Crossings)])
    lengths = {name: _number(path, name, values[name], least=0.0)
               for name in ("length", "half_width", "kerb", "far")}
    return Crossings(**lengths, zebras=_items(path, "zebras", values["zebras"], Zebra))


def load_scenery(path: Path | None = None) -> Scenery:
    """From the package's own file, or another one; SettingsError names file and key."""
    path = path or config_folder() / "lane_scenery.yaml"
    values = _read_keys(path, [field.name for field in fields(Scenery)])
    sun = values["sun"]
    if not isinstance(sun, list) or len(sun) != 3:
        raise SettingsError(f"{path}: sun: must be [x, y, z], is {sun!r}")
    direction = tuple(_number(path, f"sun[{i}]", value) for i, value in enumerate(sun))
    if direction[2] >= 0:
        raise SettingsError(f"{path}: sun: must shine downwards (z below 0), is {sun!r}")
    return Scenery(direction, _number(path, "shade", values["shade"], least=0.0),
                   _items(path, "trees", values["trees"], Tree),
                   _items(path, "lamps", values["lamps"], Lamp))


def config_folder() -> Path:
    """The package's config folder."""
    return Path(rospkg.RosPack().get_path("lane_keeping")) / "config"


def _read_keys(path: Path, expected: list[str]) -> dict:
    values = read_table(path)
    for kind, wrong in (("unknown", values.keys() - set(expected)),
                        ("missing", set(expected) - values.keys())):
        if wrong:
            raise SettingsError(f"{path}: {kind} key {min(wrong, key=str)!r};"
                                f" there are: {', '.join(expected)}")
    return values


def _items(path: Path, name: str, values: object, kind: type) -> tuple:
    """A list of mappings with exactly the keys of a dataclass of numbers."""
    keys = [field.name for field in fields(kind)]
    if not isinstance(values, list):
        raise SettingsError(f"{path}: {name}: must be a list of {{{', '.join(keys)}}}")
    found = []
    for number, item in enumerate(values):
        place = f"{name}[{number}]"
        if not isinstance(item, dict) or set(item) != set(keys):
            raise SettingsError(
                f"{path}: {place}: must have the keys {', '.join(keys)}, is {item!r}")
        found.append(kind(**{key: _number(path, f"{place}.{key}", item[key]) for key in keys}))
    return tuple(found)


def _number(path: Path, place: str, value: object, least: float = -math.inf) -> float:
    fits = type(value) in (int, float) and math.isfinite(value) and value >= least
    if not fits:
        more = "" if least == -math.inf else f", {least:g} or more"
        raise SettingsError(f"{path}: {place}: must be a number{more}, is {value!r}")
    return float(value)


def person_begin(zebra: Zebra, crossings: Crossings) -> tuple[float, float, float]:
    """x, y (m) and yaw (rad) of a waiting person: on the right, looking across the road."""
    yaw = zebra.heading + math.pi / 2
    x = zebra.x - crossings.far * math.cos(yaw)
    y = zebra.y - crossings.far * math.sin(yaw)
    return x, y, math.remainder(yaw, 2 * math.pi)

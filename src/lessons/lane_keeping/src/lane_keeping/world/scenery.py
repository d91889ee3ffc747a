"""The YAML files about the lane: zebra crossings, trees, lamps, and the sun's direction."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeVar

import rospkg
from node_basics.records import Anywhere, Must, are, is_number, read_yaml, to_record
from node_basics.settings import SettingsError

PERSON_RADIUS = 0.12  # m, of the collision shape
T = TypeVar("T")
Downwards = Annotated[tuple[float, float, float], Must(
    "[x, y, z] with z below 0", lambda value: are(
        value, lambda part: is_number(part, -math.inf), 3) and value[2] < 0)]


@dataclass(frozen=True)
class Zebra:
    """A crossing's centre, m, and the lane's heading there, rad."""

    x: Anywhere
    y: Anywhere
    heading: Anywhere


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

    x: Anywhere
    y: Anywhere
    crown: Anywhere
    height: Anywhere


@dataclass(frozen=True)
class Lamp:
    """Place and height; m."""

    x: Anywhere
    y: Anywhere
    height: Anywhere


@dataclass(frozen=True)
class Scenery:
    """lane_scenery.yaml, key by key."""

    sun: Downwards  # direction of its light
    shade: float  # share of the light that remains in the shade
    trees: tuple[Tree, ...]
    lamps: tuple[Lamp, ...]

    def shadow_of(self, x: float, y: float, height: float) -> tuple[float, float]:
        """Where the shade of a point at this height (m) falls on the ground."""
        return x - self.sun[0] / self.sun[2] * height, y - self.sun[1] / self.sun[2] * height


def load_crossings(path: Path | None = None) -> Crossings:
    """From the package's own file, or another one; SettingsError names file and key."""
    return _load(Crossings, path or config_folder() / "crossings.yaml")


def load_scenery(path: Path | None = None) -> Scenery:
    """From the package's own file, or another one; SettingsError names file and key."""
    return _load(Scenery, path or config_folder() / "lane_scenery.yaml")


def _load(kind: type[T], path: Path) -> T:
    return to_record(kind, read_yaml(path, SettingsError), path, SettingsError)


def config_folder() -> Path:
    """The package's config folder."""
    return Path(rospkg.RosPack().get_path("lane_keeping")) / "config"


def person_begin(zebra: Zebra, crossings: Crossings) -> tuple[float, float, float]:
    """x, y (m) and yaw (rad) of a waiting person: on the right, looking across the road."""
    yaw = zebra.heading + math.pi / 2
    x = zebra.x - crossings.far * math.cos(yaw)
    y = zebra.y - crossings.far * math.sin(yaw)
    return x, y, math.remainder(yaw, 2 * math.pi)

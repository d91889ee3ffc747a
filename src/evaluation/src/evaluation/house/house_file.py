"""What is driven: world, robot, way-points and rules for goals, from a file of houses/."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path

from evaluation.session.failure import RunError
from evaluation.session.resources import find_package, read_keys


@dataclass(frozen=True)
class House:
    """A house file, key by key; m and rad, in the world's frame."""

    world: str  # path, or package://PACKAGE/PATH
    model: str  # of TurtleBot3
    start: tuple[float, float, float]
    laser_height: float
    laser_reach: float  # beyond it walls are not mapped
    passable: float  # from a wall to the robot's reference point, at least
    max_speed: float  # m/s
    goal_clearance: float  # from a wall to a drawn goal, at least
    goal_distance: float  # from one drawn goal to the next, at least
    way_points: tuple[tuple[float, float], ...]  # of the mapping round

    @property
    def world_path(self) -> Path:
        """Where the world file is."""
        package, _, rest = self.world.removeprefix("package://").partition("/")
        found = find_package(package) / rest if self.world.startswith("package://") else Path(
            self.world)
        return found.resolve()


def load_house(name: str) -> House:
    """House `name` of houses/, or the file of that path; RunError names file and key."""
    folder = find_package("evaluation") / "houses"
    path = Path(name) if name.endswith(".yaml") else folder / f"{name}.yaml"
    if not name.endswith(".yaml") and not path.exists():
        known = ", ".join(sorted(found.stem for found in folder.glob("*.yaml")))
        raise RunError(f"no house {name!r} (--house); there are: {known}")
    values = read_keys(path, [field.name for field in fields(House)])
    for key, value in values.items():
        wanted, fits = _RULES[key]
        if not fits(value):
            raise RunError(f"{path}: {key}: must be {wanted}, is {value!r}")
    return House(**{**values, "start": tuple(values["start"]),
                    "way_points": tuple(tuple(point) for point in values["way_points"])})


def _is_number(value: object) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _is_length(value: object) -> bool:
    return _is_number(value) and value > 0


def _are_numbers(value: object, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(map(_is_number, value))


def _are_points(value: object) -> bool:
    return isinstance(value, list) and bool(value) and all(_are_numbers(p, 2) for p in value)


def _is_text(value: object) -> bool:
    return isinstance(value, str) and bool(value)


_TEXT, _LENGTH = ("a text", _is_text), ("a number above 0", _is_length)
_RULES: dict[str, tuple[str, Callable[[object], bool]]] = {
    "world": _TEXT, "model": _TEXT,
    "start": ("[x, y, yaw]", lambda value: _are_numbers(value, 3)),
    "laser_height": _LENGTH, "laser_reach": _LENGTH, "passable": _LENGTH, "max_speed": _LENGTH,
    "goal_clearance": _LENGTH, "goal_distance": _LENGTH,
    "way_points": ("a list of [x, y]", _are_points),
}  # fmt: skip

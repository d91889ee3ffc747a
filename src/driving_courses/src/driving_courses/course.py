"""A course as its YAML file says: what is driven where, and how it is scored."""

from __future__ import annotations

import reprlib
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import yaml

from driving_courses.errors import CourseError
from driving_courses.packages import find_file

FOLDER = Path(__file__).resolve().parent / "courses"
CHOICES = {
    "task": ("lap", "follow"),
    "drive": ("gazebo_diff_drive", "diff_drive_controller", "racecar"),
    "random_track": ("", "line", "race", "scene"),
}


@dataclass(frozen=True)
class FeatureSpec:
    """What is looked for in a picture; see courses/line_follow.yaml."""

    size: tuple[int, int]  # px
    lower: tuple[int, int, int]  # hue 0..179, saturation, value
    upper: tuple[int, int, int]
    bands: tuple[tuple[float, float], ...]  # parts of the height, from the top
    halves: bool


@dataclass(frozen=True)
class CourseSpec:
    """A file of courses/, key by key; m, rad, s."""

    task: str
    course: str
    world: str
    model_paths: tuple[str, ...]
    resource_paths: tuple[str, ...]
    robot: str
    model: str
    drive: str
    settings: str
    speeds: tuple[float, float]
    turn: float
    steering_angle: float
    wheelbase: float
    random_track: str
    features: FeatureSpec

    @property
    def track_file(self) -> Path:
        """Where the line is that laps go along."""
        return find_file(self._evaluated()["track"])

    @property
    def off_course(self) -> float:
        """m beside the line: farther than this and the car has left the course."""
        return float(self._evaluated()["off_course"])

    def _evaluated(self) -> dict:
        return yaml.safe_load(
            find_file(f"evaluation/courses/{self.course}.yaml").read_text(encoding="utf-8"))


def load_course(name: str | Path) -> CourseSpec:
    """The course of that name in courses/, or of a .yaml file; CourseError names file and key."""
    path = FOLDER / f"{name}.yaml" if not str(name).endswith(".yaml") else Path(name)
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        known = ", ".join(sorted(found.stem for found in FOLDER.glob("*.yaml")))
        raise CourseError(f"{path}: {error.strerror}; there are: {known}") from error
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise CourseError(f"{path}: not valid YAML: {' '.join(str(error).split())[:200]}") \
            from error
    course = _fill(CourseSpec, values, str(path))
    for key, known in CHOICES.items():
        if getattr(course, key) not in known:
            raise CourseError(f"{path}: {key}: must be one of {', '.join(map(repr, known))},"
                              f" is {getattr(course, key)!r:.80}")
    return course


def _fill(kind: type, values: Any, place: str) -> Any:
    """The dataclass `kind` from a mapping that has exactly its fields, of their types."""
    expected = {field.name: field.type for field in fields(kind)}
    given = set(values) if isinstance(values, dict) else set()
    for key in [*sorted(map(str, given - set(expected))), *(k for k in expected if k not in given)]:
        which = "unknown" if key in given else "missing"
        raise CourseError(f"{place}: {which} key {key!r:.80}; there are: {', '.join(expected)}")
    found = {}
    for key, wanted in expected.items():
        value = values[key]
        if wanted == "FeatureSpec":
            found[key] = _fill(FeatureSpec, value, f"{place}: {key}")
        elif not _fits(value, wanted):
            raise CourseError(f"{place}: {key}: must be {_WANTED[wanted]}, is "
                              f"{reprlib.repr(value)[:80]}")
        else:
            found[key] = _frozen(value)
    return kind(**found)


def _fits(value: Any, wanted: str) -> bool:
    if wanted == "float":
        return type(value) in (int, float) and value > 0
    if wanted == "tuple[float, float]":
        return (isinstance(value, list) and len(value) == 2
                and all(type(end) in (int, float) for end in value) and value[0] <= 0 < value[1])
    if wanted in ("str", "bool"):
        return type(value).__name__ == wanted
    if not isinstance(value, list):
        return False
    if wanted == "tuple[str, ...]":
        return all(isinstance(each, str) for each in value)
    if wanted == "tuple[tuple[float, float], ...]":
        return bool(value) and all(
            isinstance(band, list) and len(band) == 2
            and all(type(edge) in (int, float) for edge in band) and 0 <= band[0] < band[1] <= 1
            for band in value)
    return (len(value) == wanted.count("int")
            and all(type(each) is int and each >= 0 for each in value))


_WANTED = {"float": "a number above 0", "tuple[float, float]": "[0 or less, above 0]",
           "str": "a text", "bool": "true or false",
           "tuple[str, ...]": "a list of texts", "tuple[int, int]": "two whole numbers",
           "tuple[int, int, int]": "three whole numbers",
           "tuple[tuple[float, float], ...]": "a list of [from, to], each within 0..1"}


def _frozen(value: Any) -> Any:
    return tuple(map(_frozen, value)) if isinstance(value, list) else value

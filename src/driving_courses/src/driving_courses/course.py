"""A course as its YAML file says: what is driven where, and how it is scored."""

from __future__ import annotations

import errno
import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import yaml

from driving_courses.errors import CourseError
from driving_courses.packages import find_file
from run_session.records import Length, Must, are, is_number, read_yaml, to_record

FOLDER = Path(__file__).resolve().parent / "courses"
CHOICES = {
    "task": ("lap", "follow"),
    "drive": ("gazebo_diff_drive", "diff_drive_controller", "racecar"),
    "random_track": ("", "line", "race", "scene"),
}


def _is_band(value: Any) -> bool:
    return are(value, is_number, 2) and value[0] < value[1] <= 1


Bands = Annotated[tuple[tuple[float, float], ...], Must(
    "a list of [from, to], each within 0..1", lambda value: bool(value) and are(value, _is_band))]
Speeds = Annotated[tuple[float, float], Must("[0 or less, above 0]", lambda value: are(
    value, lambda end: is_number(end, -math.inf), 2) and value[0] <= 0 < value[1])]


@dataclass(frozen=True)
class FeatureSpec:
    """What is looked for in a picture; see courses/line_follow.yaml."""

    size: tuple[int, int]  # px
    lower: tuple[int, int, int]  # hue 0..179, saturation, value
    upper: tuple[int, int, int]
    bands: Bands  # parts of the height, from the top
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
    speeds: Speeds
    turn: Length
    steering_angle: Length
    wheelbase: Length
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
    if not path.exists():
        known = ", ".join(sorted(found.stem for found in FOLDER.glob("*.yaml")))
        raise CourseError(f"{path}: {os.strerror(errno.ENOENT)}; there are: {known}")
    course = to_record(CourseSpec, read_yaml(path, CourseError), path, CourseError)
    for key, known in CHOICES.items():
        if getattr(course, key) not in known:
            raise CourseError(f"{path}: {key}: must be one of {', '.join(map(repr, known))},"
                              f" is {getattr(course, key)!r:.80}")
    return course

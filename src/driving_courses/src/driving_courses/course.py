"""A course as its YAML file says: what is driven where, and how it is scored."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import yaml
from node_basics.records import Length, Must, are, is_number, is_whole, load_record

from driving_courses.errors import CourseError
from driving_courses.packages import find_file

FOLDER = Path(__file__).resolve().parent / "courses"


def _one_of(*names: str) -> Must:
    return Must(f"one of {', '.join(map(repr, names))}", names.__contains__)


def _is_band(value: object) -> bool:
    return are(value, lambda edge: is_number(edge, 0, 1), 2) and value[0] < value[1]


Colour = Annotated[tuple[int, int, int], Must(
    "three whole numbers", lambda value: are(value, is_whole, 3))]
Sides = Annotated[tuple[int, int], Must("two whole numbers", lambda value: are(value, is_whole, 2))]
Bands = Annotated[tuple[tuple[float, float], ...], Must(
    "a list of [from, to], each within 0..1", lambda value: bool(value) and are(value, _is_band))]
Speeds = Annotated[tuple[float, float], Must("[0 or less, above 0]", lambda value: are(
    value, lambda end: is_number(end, -math.inf), 2) and value[0] <= 0 < value[1])]


@dataclass(frozen=True)
class FeatureSpec:
    """What is looked for in a picture; see courses/line_follow.yaml."""

    size: Sides  # px
    lower: Colour  # hue 0..179, saturation, value
    upper: Colour
    bands: Bands  # parts of the height, from the top
    halves: bool


@dataclass(frozen=True)
class CourseSpec:
    """A file of courses/, key by key; m, rad, s."""

    task: Annotated[str, _one_of("lap", "follow")]
    course: str
    world: str
    model_paths: tuple[str, ...]
    resource_paths: tuple[str, ...]
    robot: str
    model: str
    drive: Annotated[str, _one_of("gazebo_diff_drive", "diff_drive_controller", "racecar")]
    settings: str
    speeds: Speeds
    turn: Length
    steering_angle: Length
    wheelbase: Length
    random_track: Annotated[str, _one_of("", "line", "race", "scene")]
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
    return load_record(CourseSpec, str(name), FOLDER, CourseError)

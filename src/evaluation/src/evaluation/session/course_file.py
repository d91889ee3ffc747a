"""What is driven: launch file, robot, topics and track, from a file of courses/."""

from __future__ import annotations

import importlib
import math
import os
import re
from dataclasses import dataclass, fields
from pathlib import Path

from evaluation.session.failure import RunError
from evaluation.session.resources import find_package, read_keys


@dataclass(frozen=True)
class Course:
    """A course file, key by key."""

    launch: tuple[str, str]  # package and launch file, which has an argument `follower`
    follower_package: str
    followers: str  # files among which those that drive are, with * for any text: below the
    # package's folder, or python://PACKAGE/... for modules
    follower: str  # the script that drives unless another is asked for
    drives_by: str  # a word that stands in files that drive
    robot: str  # model name in the simulator; {VARIABLE:default} is taken from the environment
    robot_argument: str  # launch argument that replaces the variable
    track: str  # path, or package://PACKAGE/PATH
    off_course: float  # m beside the line
    out: str  # where results go
    camera: str
    camera_info: str
    commands: str  # geometry_msgs/Twist, one for each image
    odometry: str  # nav_msgs/Odometry, true poses
    controllers: str  # namespace of the controller manager that takes the lockstep topics, or ""
    lockstep: tuple[str, ...]  # topics that the world waits for after each image
    sensors: tuple[str, ...]  # topics that go into the fingerprint
    film_band: float  # share of the image's height where the film marks the line; 0: nowhere

    def robot_name(self, launch_args: tuple[str, ...]) -> str:
        """The model's name, as the launch file with these arguments (name:=value) spawns it."""
        given = [arg.split(":=", 1) for arg in launch_args]
        asked = [value for name, value in given if self.robot_argument and
                 name == self.robot_argument]

        def fill(found: re.Match) -> str:
            return asked[-1] if asked else os.environ.get(found[1]) or found[2]

        return re.sub(r"\{(\w+):(\w+)\}", fill, self.robot)

    def controller_names(self) -> set[str]:
        """Those that must have been started before time begins."""
        within = f"{self.controllers}/"
        return {topic.removeprefix(within).partition("/")[0] for topic in self.lockstep
                if self.controllers and topic.startswith(within)}

    def follower_files(self) -> list[Path]:
        """All files that `followers` fits."""
        package, _, rest = self.followers.removeprefix("python://").partition("/")
        if not self.followers.startswith("python://"):
            return list(find_package(self.follower_package).glob(self.followers))
        folders = importlib.import_module(package).__path__
        return [path for folder in folders for path in Path(folder).glob(rest)]

    def track_path(self) -> Path:
        """Where the track file is."""
        package, _, rest = self.track.removeprefix("package://").partition("/")
        return find_package(package) / rest if self.track.startswith("package://") else Path(
            self.track)


def load_course(name: str) -> Course:
    """Course `name` of courses/, or the file of that path; RunError names file and key."""
    folder = find_package("evaluation") / "courses"
    path = Path(name) if name.endswith(".yaml") else folder / f"{name}.yaml"
    if not name.endswith(".yaml") and not path.exists():
        known = ", ".join(sorted(found.stem for found in folder.glob("*.yaml")))
        raise RunError(f"no course {name!r} (--course); there are: {known}")
    return _checked(path, read_keys(path, [field.name for field in fields(Course)]))


def _checked(path: Path, values: dict) -> Course:
    expected = {field.name: field.type for field in fields(Course)}
    for key, kind in expected.items():
        if kind == "float":
            fits = type(values[key]) in (int, float) and 0 <= values[key] < math.inf
        elif kind == "str":
            fits = isinstance(values[key], str)
        else:
            fits = isinstance(values[key], list) and all(isinstance(v, str) for v in values[key])
        if not fits or (key == "launch" and len(values[key]) != 2):
            raise RunError(f"{path}: {key}: must be {_WANTED[kind]}, is {values[key]!r}")
    return Course(**{key: tuple(value) if isinstance(value, list) else value
                     for key, value in values.items()})


_WANTED = {"float": "a number, 0 or more", "str": "a text", "tuple[str, ...]": "a list of topics",
           "tuple[str, str]": "[package, file]"}

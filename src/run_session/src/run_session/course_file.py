"""Course files: launch file, robot, topics and track of a course."""

from __future__ import annotations

import importlib
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from node_basics.records import Must, are, is_text, load_record

from run_session.failure import RunError
from run_session.files import find_package, located

Topics = Annotated[tuple[str, ...], Must("a list of topics", lambda value: are(value, is_text))]
LaunchFile = Annotated[
    tuple[str, str], Must("[package, file]", lambda value: are(value, is_text, 2))]


@dataclass(frozen=True)
class CourseFile:
    """A course file, key by key."""

    launch: LaunchFile  # package and launch file, which has an argument `follower`
    follower_package: str
    followers: str  # glob pattern of files, some of which are followers: below the
    # package's folder, or python://PACKAGE/... for modules
    follower: str  # the script that drives by default
    drives_by: str  # a word by which the files that are followers are recognised
    robot: str  # model name in the simulator; {VARIABLE:default} is taken from the environment
    robot_argument: str  # launch argument that replaces the variable
    track: str  # path, or package://PACKAGE/PATH
    off_course: float  # m beside the line
    out: str  # where results go
    camera: str
    camera_info: str
    commands: str  # topic of geometry_msgs/Twist, one for each image
    odometry: str  # topic of nav_msgs/Odometry, true poses
    controllers: str  # namespace of the controller manager that takes the lockstep topics, or ""
    lockstep: Topics  # topics that the world waits for after each image
    sensors: Topics  # topics that go into the fingerprint
    line_colour: str  # #rrggbb, in pictures: of the line that is followed, as the camera sees it
    film_band: float  # share of the image's height at which the video marks the line; 0: nowhere

    def robot_name(self, launch_args: tuple[str, ...]) -> str:
        """The model's name, as the launch file with these arguments (name:=value) spawns it."""
        given = [arg.split(":=", 1) for arg in launch_args]
        asked = [value for name, value in given if self.robot_argument and
                 name == self.robot_argument]

        def fill(found: re.Match) -> str:
            return asked[-1] if asked else os.environ.get(found[1]) or found[2]

        return re.sub(r"\{(\w+):(\w+)\}", fill, self.robot)

    def controller_names(self) -> set[str]:
        """Controllers that must have been started before simulated time begins."""
        within = f"{self.controllers}/"
        return {topic.removeprefix(within).partition("/")[0] for topic in self.lockstep
                if self.controllers and topic.startswith(within)}

    def follower_files(self) -> list[Path]:
        """All files that match `followers`."""
        package, _, rest = self.followers.removeprefix("python://").partition("/")
        if not self.followers.startswith("python://"):
            return list(find_package(self.follower_package).glob(self.followers))
        folders = importlib.import_module(package).__path__
        return [path for folder in folders for path in Path(folder).glob(rest)]

    def track_path(self) -> Path:
        """Where the track file is."""
        return located(self.track)


def load_course(name: str) -> CourseFile:
    """Course `name` of courses/, or the file at that path; a RunError names file and key."""
    return load_record(CourseFile, name, find_package("evaluation") / "courses", RunError)


def drivers(course: CourseFile) -> list[str]:
    """Names of the files that can drive on it."""
    return sorted(path.name for path in course.follower_files() if course.drives_by
                  in path.read_text(encoding="utf-8", errors="replace"))

"""A case: course, track, and start pose and light from a seed; its file for its process."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from racecar_description.track.closed_line import build_track, load_track
from racecar_description.track.course_model import floor_files
from racecar_description.track.errors import TrackError
from racecar_description.track.painted_plane import write_files
from racecar_description.track.track_file import load_track_file

from evaluation.lap import Disturbance, LapScorer, Sample
from evaluation.lap_trial import MODEL_PATH
from marking.rules import Limits, Rules
from run_session.course_file import CourseFile, load_course
from run_session.failure import RunError
from run_session.files import find_package, world_argument
from trial_worlds.light import write_lit_world

# By course: its name is our launch file's; the value is a course file of evaluation.
COURSES = {"course": "course", "race": "race", "lane": "lane_empty"}


def driven(name: str) -> CourseFile:
    """The course file, with a launch file that starts no driver."""
    return replace(load_course(COURSES[name]), launch=("marking", f"{name}.launch"))


@dataclass(frozen=True)
class Scene:
    """The files of a case's course."""

    track: Path  # YAML of its centre line
    models: str  # folders of models, for an environment variable
    launch_args: list[str]  # for roslaunch, name:=value


def make_scene(rules: Rules, track: int, seed: int, folder: Path) -> Scene:
    """Make the scene of a track (0: the course's own) and a seed; its files go to the folder."""
    path = Path(rules.tracks[track - 1]) if track else None
    world, line, models = _VENUES[rules.course](path, folder / "track")
    draw = _draw(rules, seed)
    lit = write_lit_world(world, models, draw.light, folder / "world")
    x, y, yaw = draw.start(load_track(line))
    arguments = {
        "x_pos": f"{x:.6f}", "y_pos": f"{y:.6f}", "yaw": f"{yaw:.6f}",
        "seed": seed, "gui": "false", "paused": "true", "real_time_factor": 0,
        "pub_clock_frequency": 30, "lockstep": ",".join(driven(rules.course).lockstep),
        "lockstep_timeout": f"{rules.limits.answer_s:g}",
        **dict(zip(("camera_width", "camera_height"), rules.camera, strict=False))}
    folders = (folder / "world" / "models", models, os.environ.get(MODEL_PATH, ""))
    return Scene(line, ":".join(map(str, folders)),
                 [world_argument(lit), *(f"{name}:={value}" for name, value in arguments.items())])


def _draw(rules: Rules, seed: int) -> Disturbance:
    """Start pose and light of a case, uniformly distributed within the rules' bounds."""
    random = np.random.default_rng(seed)
    most, turn = rules.start_sideways_m, math.radians(rules.start_turn_deg)
    return Disturbance(sideways=random.uniform(-most, most), along=0.0,
                       turn=random.uniform(-turn, turn), camera_noise=0.0,
                       light=random.uniform(*rules.light))


# A course's world, its track's YAML, and the folder of the world's own models.
_Venue = tuple[Path, Path, Path]


def _course(track: Path | None, out: Path) -> _Venue:
    package = find_package("learning_topic")
    world = package / "worlds" / "course.world"
    if track is None:
        return world, load_course("course").track_path(), package / "models"
    try:
        write_files(floor_files(load_track_file(track)), out / "turtlebot3_autorace" / "course")
    except TrackError as error:
        raise RunError(str(error)) from error
    return world, track, out


def _race(track: Path | None, _out: Path) -> _Venue:
    """A track of make_track: FOLDER/tracks/NAME.yaml beside FOLDER/worlds and FOLDER/models."""
    root = find_package("racecar_description") if track is None else track.parents[1]
    name = "racetrack" if track is None else track.stem
    world = root / "worlds" / f"{name}.world"
    if not world.exists():
        raise RunError(f"{track}: there is no {world}; make it by racecar_description's make_track")
    return world, root / "tracks" / f"{name}.yaml", root / "models"


def _lane(track: Path | None, _out: Path) -> _Venue:
    if track is not None:
        raise RunError("tracks: the lane has its own alone: tracks: []")
    root = find_package("lane_keeping")
    return root / "worlds" / "lane_empty.world", load_course("lane_empty").track_path(), (
        root / "models")


_VENUES = {"course": _course, "race": _race, "lane": _lane}


CASE, REPORT, PATH_PICTURE, THUMBNAIL, OUTPUT, FILM = (
    "case.json", "report.json", "path.png", "path.webp", "output.txt", "film.mp4")
STATE_LOG = "state.jsonl"


@dataclass(frozen=True)
class CaseFile:
    """FOLDER/case.json, key by key."""

    rules: str  # path
    kind: str  # sandbox kind
    course: str
    laps: int
    submission: str  # folder
    program: str  # relative to it
    track: str  # path
    film: bool
    launch_args: list[str]  # for roslaunch, name:=value
    timed: bool = False  # in real time: the world hardly waits for an answer

    def write(self, folder: Path) -> None:
        """Write it into the case's folder."""
        (folder / CASE).write_text(json.dumps(asdict(self), indent=1), encoding="utf-8")

    def by_time(self, limits: Limits) -> CaseFile:
        """The same case in real time, for a program that sends commands by its own timer.

        The world still waits a moment after each image, so that a command from a timer in
        simulated time arrives before time goes on.
        """
        changed = {"real_time_factor": "1", "lockstep_timeout": f"{limits.timed_answer_s:g}"}
        kept = [each for each in self.launch_args if each.partition(":=")[0] not in changed]
        return replace(self, timed=True, launch_args=[
            *kept, *(f"{name}:={value}" for name, value in changed.items())])

    def driven(self) -> CourseFile:
        """The course to drive."""
        return driven(self.course)

    def robot(self) -> str:
        """The car's model name in the simulator."""
        return self.driven().robot_name(tuple(self.launch_args))

    def scorer(self) -> LapScorer:
        """A new scorer for this case."""
        track = build_track(load_track_file(Path(self.track)))
        return LapScorer(track, self.laps, off_course=self.driven().off_course)


def read_case(folder: Path) -> CaseFile:
    """Read what `write` wrote."""
    return CaseFile(**json.loads((folder / CASE).read_text(encoding="utf-8")))


def sample_of(entry: dict, robot: str) -> Sample | None:
    """The robot's pose from an entry of the state log; None if it has none."""
    pose: Sequence[float] | None = entry.get("poses", {}).get(robot)
    if pose is None:
        return None
    x, y, _, qx, qy, qz, qw = pose
    yaw = math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz))
    return Sample(entry["time"], x, y, yaw)

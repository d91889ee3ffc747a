"""Where submissions drive: a course's own track, or one that the teacher gives."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from evaluation.course_model import write_model
from evaluation.session.course_file import Course, load_course
from evaluation.session.failure import RunError
from evaluation.session.resources import find_package
from evaluation.track import TrackError, load_track_file

# What can be driven: our launch file of that name, and the course file of evaluation's.
COURSES = {"course": "course", "race": "race", "lane": "lane_empty"}


@dataclass(frozen=True)
class Venue:
    """One track and what belongs to it."""

    world: Path
    track: Path  # YAML of its centre line
    models: Path  # folder of the world's own models


def course_venue(course: str, track: Path | None, out: Path) -> Venue:
    """The course on its own track, or on this one; what has to be made lies below `out`."""
    if course == "race":
        return _race_venue(track)
    if course == "lane":
        return _lane_venue(track)
    world = find_package("learning_topic") / "worlds" / "course.world"
    models = find_package("learning_topic") / "models"
    if track is None:
        return Venue(world, load_course(course).track_path(), models)
    made = out / track.stem / "models"
    try:
        write_model(load_track_file(track), made / "turtlebot3_autorace" / "course")
    except TrackError as error:
        raise RunError(str(error)) from error
    return Venue(world, track, made)


def driven(name: str) -> Course:
    """The course file, with a launch file that starts no driver."""
    return replace(load_course(COURSES[name]), launch=("marking", f"{name}.launch"))


def _lane_venue(track: Path | None) -> Venue:
    if track is not None:
        raise RunError("tracks: the lane has its own alone: tracks: []")
    root = find_package("lane_keeping")
    return Venue(root / "worlds" / "lane_empty.world", load_course("lane_empty").track_path(),
                 root / "models")


def _race_venue(track: Path | None) -> Venue:
    """A track of make_track: FOLDER/tracks/NAME.yaml beside FOLDER/worlds and FOLDER/models."""
    root = find_package("racecar_description") if track is None else track.parents[1]
    name = "racetrack" if track is None else track.stem
    world = root / "worlds" / f"{name}.world"
    if not world.exists():
        raise RunError(f"{track}: there is no {world}; make it by racecar_description's make_track")
    return Venue(world, root / "tracks" / f"{name}.yaml", root / "models")

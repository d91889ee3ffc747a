"""Where laps are driven: the racetrack, and random tracks."""

from __future__ import annotations

from pathlib import Path

from racecar_description.track.from_numbers import from_seed
from racecar_description.track.model_files import write_course
from racecar_description.track.wishes import Wishes

from evaluation.laps.lap_trial import Venue
from run_session.resources import find_package


def racetrack() -> Venue:
    """The one in racecar_description."""
    return _venue("racetrack", find_package("racecar_description"))


def random_track(seed: int, out: Path) -> Venue:
    """The seed's track, as make_track makes it, made anew below `out`."""
    course, _ = from_seed(seed, Wishes(f"random_{seed}"))
    write_course(course, out)
    return _venue(course.name, out)


def _venue(name: str, root: Path) -> Venue:
    return Venue(root / "worlds" / f"{name}.world", root / "tracks" / f"{name}.yaml",
                 root / "models")

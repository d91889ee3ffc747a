"""One case as a file, for the process that drives it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from racecar_description.track.closed_line import build_track
from racecar_description.track.track_file import load_track_file

from evaluation.lap import LapScorer
from marking.rules import Limits
from marking.venues import driven
from run_session.course import Course

CASE, REPORT, PATH_PICTURE, OUTPUT, FILM = (
    "case.json", "report.json", "path.png", "output.txt", "film.mp4")


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

    def driven(self) -> Course:
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

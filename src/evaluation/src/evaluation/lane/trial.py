"""`make lane-trials`: laps in varied light, then encounters with people."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from lane_keeping.settings import SettingsError
from lane_keeping.world.scenery import load_crossings
from racecar_description.track.track_file import load_track_file

from evaluation.lane.encounters import judge, nearest_ever
from evaluation.lane.outcomes import LaneDrive, encounter_table, from_report, lap_table
from evaluation.lane.recording import read_recording
from evaluation.laps.disturbance import Bounds, draw
from evaluation.laps.lap_trial import LapTrial, Outing, Venue
from evaluation.session.course_file import drivers, load_course
from evaluation.trial.command_line import Parser, one_of
from evaluation.trial.protocol import REPORT, Case
from run_session.failure import RunError
from run_session.resources import find_package

LAPS_WITH_PEOPLE = 4  # in a row; starting a simulator takes as long as a quarter of a lap
PEOPLE_FROM = 500  # first seed of the drives with people
BOUNDS = Bounds(sideways=0.05, along=0.0, turn=0.1, camera_noise=(0.0, 0.02), light=(0.6, 1.4))
NEAR = 3.0  # m: people set off once the car is this close, so that they meet
LONGEST_LAP = 240.0  # s, simulated


@dataclass(frozen=True)
class LaneCase(Case):
    """A drive: method's name, seed, laps in a row, and whether people cross."""

    method: str
    seed: int
    laps: int
    people: bool


def lane_case(method: str, seed: int, people: bool = False) -> LaneCase:
    """The case of one lap without people, or of several with people."""
    name = f"{method} {'people' if people else 'laps'}-{seed}"
    return LaneCase(name, method, seed, LAPS_WITH_PEOPLE if people else 1, people)


class LaneDrives(LapTrial):
    """Shared by the trials of one method and the comparison of all."""

    result = LaneDrive

    def outing(self, out: Path, case: LaneCase) -> Outing:
        """With people, poses.txt is written beside the report."""
        lit = out / "drives" / case.name.partition(" ")[2]
        folder = lit / case.method
        package, course = find_package("lane_keeping"), "lane" if case.people else "lane_empty"
        venue = Venue(package / "worlds" / f"{course}.world", load_course(course).track_path(),
                      package / "models")
        options, record = (), ()
        if case.people:
            options = ("--launch", "evaluation", "lane.launch")
            record = (f"near:={NEAR:g}", f"record:={folder / 'poses.txt'}")
        return Outing(f"{case.method}, seed {case.seed}", course, f"{case.method}.py", venue, lit,
                      folder, draw(case.seed, BOUNDS), LONGEST_LAP, case.laps, options, record)

    def score(self, record: dict) -> LaneDrive:
        case = self._case
        found = from_report(record, case.method, case.seed, self._outing.disturbance, case.people)
        if not case.people:
            return found
        recording = read_recording(self._outing.out / "poses.txt")
        lane_half = load_track_file(self._outing.venue.track).lane_width
        try:
            met = judge(recording, load_crossings(), lane_half)
        except SettingsError as error:
            raise RunError(str(error)) from error
        return replace(found, nearest_person=round(nearest_ever(recording), 3),
                       encounters=tuple(met))

    def earlier(self, options: argparse.Namespace) -> list[LaneDrive]:
        """Results so far; it is no error if there are none."""
        return super().earlier(options) if (options.out / REPORT).exists() else []


class LaneTrial(LaneDrives):
    """One method's laps without people, and drives with people until enough were met."""

    program = "lane_trials"
    does = "Drive laps in differing light and past people."
    good = "all within the limits"
    writes = "report.json, report.html and the drives"
    open_ended, shared = True, ("method",)

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "laps without people")
        parser.add_whole("--crossings", 100, "people to meet")
        parser.add_argument("--method", default="sliding_windows", metavar="NAME",
                            help="(sliding_windows)")

    def check(self, options: argparse.Namespace) -> None:
        one_of("method", "METHOD", known_methods(), options.method)
        if not options.seeds and not options.crossings:
            raise RunError("--seeds 0 --crossings 0: nothing to drive")
        self._crossings = options.crossings

    def cases(self, options: argparse.Namespace) -> list[LaneCase]:
        """Includes at most as many drives with people as encounters are wanted."""
        return [*(lane_case(options.method, seed) for seed in range(options.seeds)),
                *(lane_case(options.method, PEOPLE_FROM + number, people=True)
                  for number in range(options.crossings))]

    def is_needed(self, case: LaneCase, results: Sequence[LaneDrive]) -> bool:
        return not case.people or count_met(results) < self._crossings

    def passed(self, results: Sequence[LaneDrive]) -> bool:
        if count_met(results) < self._crossings:
            raise RunError(f"fewer than {self._crossings} people were met in as many drives")
        with_people = [each for each in results if each.people]
        return (all(each.within_limits for each in results if not each.people)
                and all(each.closed and each.kept_clear for each in with_people)
                and all(met.passed for each in with_people for met in each.encounters))

    def table(self, results: Sequence[LaneDrive]) -> str:
        laps = [each for each in results if not each.people]
        people = [each for each in results if each.people]
        parts = [lap_table(laps)] if laps else []
        if people:
            closed = sum(each.closed for each in people)
            parts += [f"{closed} of {len(people)} drives with people closed",
                      encounter_table(people)]
        return "\n".join(parts)


def count_met(results: Sequence[LaneDrive]) -> int:
    """People met in all drives."""
    return sum(len(each.encounters) for each in results)


def known_methods() -> list[str]:
    """Names of all methods; sliding_windows comes first."""
    names = [Path(file).stem for file in drivers(load_course("lane"))]
    return sorted(names, key=lambda name: name != "sliding_windows")

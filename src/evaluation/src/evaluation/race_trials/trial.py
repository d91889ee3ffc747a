"""`make race-trials`: laps as `make race` drives them, each disturbed in its own way."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from racecar_description.track.closed_line import load_track

from evaluation.laps import lit_drive
from evaluation.laps.disturbance import Disturbance, draw
from evaluation.race_trials.chart import write_chart
from evaluation.race_trials.path_sheet import write_path_sheet
from evaluation.race_trials.results import (
    Lap,
    lap_from_report,
    lap_line,
    summarize,
    summary_table,
    to_json,
)
from evaluation.race_trials.venue import RACETRACK, RANDOM_TRACKS, Venue, racetrack, random_track
from evaluation.session.failure import RunError
from evaluation.session.session import Session
from evaluation.trial.command_line import Parser
from evaluation.trial.protocol import Case, Trial

LARGEST_SEED = 100_000_000  # a larger one is none for course_run
FOLLOWERS = ("lane_follow.py", "lane_follow_p.py")
LONGEST_LAP = 120.0  # s, simulated
STARTUP_LIMIT, LIMIT = 120.0, 1200.0  # s, wall
ANSWER_LIMIT = 10.0  # s, wall


@dataclass(frozen=True)
class RaceCase(Case):
    """One lap of one follower."""

    set: str
    seed: int
    follower: str


class RaceTrial(Trial):
    """Laps on the racetrack and on random tracks; the first follower must keep the limits."""

    program = "race_trials"
    does = ("Drive many laps, each with a start, camera noise and light of its own; compare"
            " followers.")
    good = "all laps of the first follower closed within the limits"
    writes = "report.json, report.html, trials.png and the laps"

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "laps on the racetrack")
        parser.add_whole("--first-seed", 0, "seed of the first of them", most=LARGEST_SEED)
        parser.add_whole("--tracks", 10, "random tracks, a lap on each")
        parser.add_whole("--first-track", 101, "seed of the first of them", most=LARGEST_SEED)
        parser.add_argument(
            "--followers", nargs="+", default=FOLLOWERS, metavar="FILE",
            help=f"scripts of car_control; the first must pass ({' '.join(FOLLOWERS)})")

    def check(self, options: argparse.Namespace) -> None:
        if not options.seeds and not options.tracks:
            raise RunError("--seeds 0 --tracks 0: nothing to drive")
        self._first = options.followers[0]

    def cases(self, options: argparse.Namespace) -> list[RaceCase]:
        """Followers take turns."""
        followers = tuple(dict.fromkeys(options.followers))
        return [RaceCase(f"{follower} {kind} {seed}", kind, seed, follower)
                for kind, first, count in ((RACETRACK, options.first_seed, options.seeds),
                                           (RANDOM_TRACKS, options.first_track, options.tracks))
                for seed, follower in itertools.product(range(first, first + count), followers)]

    def setup(self, session: Session, case: RaceCase) -> None:
        out = session.out
        self._case, self._disturbance = case, draw(case.seed)
        self._venue = (racetrack() if case.set == RACETRACK else
                       random_track(case.seed, out / "tracks"))
        folder = out / "laps" / f"{self._venue.name}-{case.seed}"
        self._folder = folder / Path(case.follower).stem
        world = lit_drive.write_world(
            self._venue.world, self._venue.models, self._disturbance.light, folder)
        arguments = course_arguments(self._venue, case.seed, self._disturbance, world)
        self._drive = lit_drive.start(session, [*arguments, "--follower", case.follower],
                                      self._folder, [folder / "models", self._venue.models])

    def run(self) -> dict:
        """course_run's report."""
        case = self._case
        return self._drive.report(
            LIMIT, f"{case.follower} on {self._venue.name}, seed {case.seed}")

    def score(self, record: dict) -> Lap:
        return lap_from_report(
            record, self._venue, self._case.seed, self._disturbance, self._folder)

    def passed(self, results: Sequence[Lap]) -> bool:
        return all(lap.within_limits for lap in results if lap.follower == self._first)

    def line(self, result: Lap) -> str:
        return lap_line(result)

    def table(self, results: Sequence[Lap]) -> str:
        return summary_table(summarize(results))

    def values(self, results: Sequence[Lap]) -> dict:
        return to_json(results)

    def from_values(self, values: dict) -> list[Lap]:
        kept = [{name: each[name] for name in Lap.__dataclass_fields__} for each in values["laps"]]
        return [Lap(**{**each, "disturbance": Disturbance(**each["disturbance"])}) for each in kept]

    def pictures(self, results: Sequence[Lap], out: Path) -> list[str]:
        write_chart(results, out / "trials.png")
        sheets = [write_path_sheet([lap for lap in results if lap.follower == follower], out)
                  for follower in dict.fromkeys(lap.follower for lap in results)]
        return ["trials.png", *(sheet.name for sheet in sheets)]


def course_arguments(venue: Venue, seed: int, disturbance: Disturbance, world: Path) -> list[str]:
    """Those of course_run, but for follower and results."""
    start = disturbance.start(load_track(venue.track))
    return [
        "--course", "race", "--track", str(venue.track), "--fast", "--no-video",
        "--seed", str(seed), "--duration", f"{LONGEST_LAP:g}",
        "--startup-timeout", f"{STARTUP_LIMIT:g}",
        *lit_drive.launch_arguments(world, start, disturbance.camera_noise, ANSWER_LIMIT),
    ]  # fmt: skip

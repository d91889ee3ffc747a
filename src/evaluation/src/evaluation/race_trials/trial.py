"""`make race-trials`: laps as in `make race`, each with its own disturbance."""

from __future__ import annotations

import argparse
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from racecar_description.track.from_numbers import from_seed
from racecar_description.track.model_files import write_course
from racecar_description.track.wishes import Wishes

from evaluation.laps.disturbance import RACE, draw
from evaluation.laps.lap_trial import LapTrial, Outing, Venue, seen
from evaluation.race_trials.outcomes import COLUMNS, Lap, summarize
from evaluation.race_trials.pictures import write_chart, write_path_sheet
from evaluation.trial.command_line import Parser
from evaluation.trial.protocol import Case
from evaluation.trial.report import grouped, table_of
from run_session.failure import RunError
from run_session.resources import find_package

RACETRACK, RANDOM_TRACKS = "racetrack", "random tracks"  # the two sets of laps
LARGEST_SEED = 100_000_000  # course_run takes no larger ones
FOLLOWERS = ("lane_follow.py", "lane_follow_p.py")
LONGEST_LAP = 120.0  # s, simulated


@dataclass(frozen=True)
class RaceCase(Case):
    """One lap of one follower."""

    set: str
    seed: int
    follower: str


class RaceTrial(LapTrial):
    """Laps on the racetrack and on random tracks; the first follower must be within the limits."""

    program = "race_trials"
    does = ("Drive many laps, each with a start, camera noise and light of its own; compare"
            " followers.")
    good = "all laps of the first follower closed within the limits"
    writes = "report.json, report.html, trials.png and the laps"
    result, listed = Lap, "laps"

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
        """The followers alternate."""
        followers = tuple(dict.fromkeys(options.followers))
        return [RaceCase(f"{follower} {kind} {seed}", kind, seed, follower)
                for kind, first, count in ((RACETRACK, options.first_seed, options.seeds),
                                           (RANDOM_TRACKS, options.first_track, options.tracks))
                for seed, follower in itertools.product(range(first, first + count), followers)]

    def outing(self, out: Path, case: RaceCase) -> Outing:
        venue = (racetrack() if case.set == RACETRACK else
                 random_track(case.seed, out / "tracks"))
        name = venue.world.stem
        self._out, folder = out, out / "laps" / f"{name}-{case.seed}"
        return Outing(f"{case.follower} on {name}, seed {case.seed}", "race", case.follower, venue,
                      folder, folder / Path(case.follower).stem, draw(case.seed, RACE), LONGEST_LAP)

    def score(self, record: dict) -> Lap:
        case, outing = self._case, self._outing
        return Lap(**seen(record, case.seed, outing.disturbance), follower=record["follower"],
                   set=case.set, track=outing.venue.world.stem,
                   folder=str(outing.out.relative_to(self._out)),
                   time=record["laps"][0]["time_s"] if record["laps"] else None)

    def passed(self, results: Sequence[Lap]) -> bool:
        return all(lap.within_limits for lap in results if lap.follower == self._first)

    def table(self, results: Sequence[Lap]) -> str:
        return table_of(COLUMNS, summarize(results), left=(0, 1))

    def values(self, results: Sequence[Lap]) -> dict:
        return super().values(results, summaries=summarize(results))

    def pictures(self, results: Sequence[Lap], out: Path) -> list[str]:
        write_chart(results, out / "trials.png")
        sheets = [write_path_sheet(laps, out)
                  for laps in grouped(results, lambda lap: lap.follower).values()]
        return ["trials.png", *(sheet.name for sheet in sheets)]


def racetrack() -> Venue:
    """The racetrack of racecar_description."""
    return _venue("racetrack", find_package("racecar_description"))


def random_track(seed: int, out: Path) -> Venue:
    """Generate the seed's track below `out`, as make_track does."""
    course, _ = from_seed(seed, Wishes(f"random_{seed}"))
    write_course(course, out)
    return _venue(course.name, out)


def _venue(name: str, root: Path) -> Venue:
    return Venue(root / "worlds" / f"{name}.world", root / "tracks" / f"{name}.yaml",
                 root / "models")

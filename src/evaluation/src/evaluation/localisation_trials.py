"""`make localisation-trials`: amcl must localise the waffle in the house, and track it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from evaluation.command_line import Parser
from evaluation.house import load_house
from evaluation.localisation_drive import LocalisationStack, find, kidnap, measure_load, track
from evaluation.localisation_results import (
    FINDING,
    KIDNAPS,
    LEAST_SHARES,
    LIMITS,
    LIMITS_IN_REPORT,
    Load,
    Result,
    Search,
    Tracking,
)
from evaluation.report import grouped, table
from evaluation.trial import Case, Trial, from_json
from map_server.errors import MapFileError
from map_server.map_files import write_map
from run_session.failure import RunError
from run_session.session import Session

RUNS = {FINDING: find, KIDNAPS: kidnap, "tracking": track, "load": measure_load}


@dataclass(frozen=True)
class LocalisationCase(Case):
    """One robot to be localised, or one drive."""

    kind: str  # of RUNS
    amount: int  # its number, or s, simulated


class LocalisationTrial(Trial):
    """All cases run in one simulator, which is started for the first of them."""

    program = "localisation_trials"
    does = ("Have amcl find the waffle in the house: from anywhere, and after it was carried away;"
            " then have it keep track of it, and see what that costs.")
    good = "all within the limits of the table"
    writes = "report.json, report.html, the map and log/"
    shared = "seed", "house", "wheel_odometry", "tracking", "load"

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--starts", 20, "robots to find anywhere in the house")
        parser.add_whole("--kidnaps", 10, "robots to find that were carried away")
        parser.add_whole("--first", 1, "number of the first of each", variable="")
        parser.add_whole("--tracking", 300, "simulated seconds to track for", variable="")
        parser.add_whole("--load", 60, "simulated seconds of 2000 particles", variable="")
        parser.add_argument(
            "--wheel-odometry", action="store_true", help="track by the wheels' odometry, too,"
            " which slips in turns: robots that are to be found always have it, a simulated"
            " TurtleBot3 has the truth")
        parser.add_whole("--seed", 0, "of places, ways, noise and particles")
        parser.add_argument("--house", default="house", metavar="NAME",
                            help="a house of houses/, or a file (house)")
        parser.add_pace("simulated seconds a second; the load is always measured at 1 (1)")

    def check(self, options: argparse.Namespace) -> None:
        if not (options.starts or options.kidnaps or options.tracking or options.load):
            raise RunError("no starts, no kidnaps, no tracking and no load: nothing to try")
        options.house = load_house(options.house)
        options.ground = options.house.ground()

    def cases(self, options: argparse.Namespace) -> list[LocalisationCase]:
        found = [LocalisationCase(f"{kind}-{number}", kind, number)
                 for kind, count in ((FINDING, options.starts), (KIDNAPS, options.kidnaps))
                 for number in range(options.first, options.first + count)]
        return found + [LocalisationCase(kind, kind, seconds) for kind, seconds in (
            ("tracking", options.tracking), ("load", options.load)) if seconds]

    def drive(self, session: Session, case: LocalisationCase) -> Result:
        """The result of the case, by its kind."""
        options = self.options
        stack = session.once(lambda: _bring_up(session, options))
        to_be_found = case.kind in (FINDING, KIDNAPS)
        stack.use_odometry(by_wheels=to_be_found or options.wheel_odometry)
        return RUNS[case.kind](stack, options.ground, options.seed, case.amount)

    def passed(self, results: Sequence[Result]) -> bool:
        """Whether all results are within the limits."""
        shares = [sum(each.right for each in found) >= LEAST_SHARES[kind] * len(found)
                  for kind, found in _sets(results).items()]
        return all(shares) and all(each.passed for each in _others(results))

    def table(self, results: Sequence[Result]) -> str:
        """A row for each kind of trial, with its limit."""
        rows = [("", "found", "wanted", "")]
        for kind, trials in _sets(results).items():
            took = [trial.took for trial in trials if trial.right]
            median = f"in {np.median(took):.1f} s (median)" if took else ""
            rows.append((f"{kind}, within {LIMITS[kind]:.0f} s",
                         f"{len(took)} of {len(trials)}",
                         f"{LEAST_SHARES[kind]:.0%}", median))
        return table([*rows, *(each.row for each in _others(results))], left=range(4))

    def values(self, results: Sequence[Result]) -> dict:
        others = {each.name: asdict(each) for each in _others(results)}
        return {"passed": self.passed(results), "limits": LIMITS_IN_REPORT,
                "trials": [{**asdict(each), "right": each.right} for each in results
                           if isinstance(each, Search)],
                "tracking": others.get("tracking"), "load": others.get("load")}

    def from_values(self, values: dict) -> list[Result]:
        found = [from_json(Search, each) for each in values["trials"]]
        return found + [from_json(kind, values[kind.name]) for kind in (Tracking, Load)
                        if values[kind.name]]


def _bring_up(session: Session, options: argparse.Namespace) -> LocalisationStack:
    try:
        _, map_file = write_map(session.out / "map", options.ground.walls)
    except (OSError, MapFileError) as error:
        raise RunError(f"--out {session.out}: {getattr(error, 'strerror', error)}") from error
    stack = LocalisationStack(options, options.ground, session.launched("robot"), str(map_file),
                              session.progress)
    session.at_end(stack.watch.stop)
    return stack


def _sets(results: Sequence[Result]) -> dict[str, list[Search]]:
    return grouped((each for each in results if isinstance(each, Search)), lambda each: each.set)


def _others(results: Sequence[Result]) -> list[Tracking | Load]:
    return [each for each in results if not isinstance(each, Search)]

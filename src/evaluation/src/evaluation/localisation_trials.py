"""`make localisation-trials`: amcl must localise the waffle in the house, and track it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import ClassVar

import numpy as np

from evaluation.command_line import Parser
from evaluation.house import load_house
from evaluation.localisation_drive import (
    FINDING,
    HOLD,
    KIDNAPS,
    LIMITS,
    LOAD,
    PARTICLES,
    RIGHT_OFF,
    RIGHT_OFF_DEG,
    RUNS,
    TRACKING,
    LocalisationCase,
    LocalisationStack,
    Record,
    right_since,
)
from evaluation.report import grouped, table
from evaluation.trial import Trial, from_json
from map_server.errors import MapFileError
from map_server.map_files import write_map
from run_session.failure import RunError
from run_session.session import Session

LEAST_SHARES = {FINDING: 0.95, KIDNAPS: 0.8}
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # m and degrees: mean error while tracking
MOST_CPU = 30.0  # percent of a core
LIMITS_IN_REPORT = {"right": [RIGHT_OFF, RIGHT_OFF_DEG], "hold": HOLD, "within": LIMITS,
                    "least_shares": LEAST_SHARES, "tracking": [MOST_OFF, MOST_OFF_DEG],
                    "cpu": MOST_CPU}


@dataclass(frozen=True)
class Search:
    """One robot that had to be localised; m, s simulated, degrees."""

    set: str
    number: int
    start: tuple[float, float, float]  # x, y, yaw in the world; m, rad
    took: float | None  # until it was right for HOLD; None: it never was
    off: float | None  # error at the end; None: there was no pose
    off_deg: float | None
    touched: int

    @property
    def name(self) -> str:
        """Its case's name."""
        return f"{self.set}-{self.number}"

    @property
    def right(self) -> bool:
        """Whether it was localised in time."""
        return self.took is not None and self.took <= LIMITS[self.set]

    @property
    def line(self) -> str:
        """A one-line summary."""
        found = "not found" if self.took is None else f"found after {self.took:.1f} s"
        late = "" if self.right or self.took is None else ", too late"
        end = (", no pose at the end" if self.off is None else
               f", at the end {self.off * 100:.1f} cm and {self.off_deg:.1f}° off")
        return f"{self.set} {self.number}: {found}{late}{end}"


@dataclass(frozen=True)
class Tracking:
    """A long drive from a known pose; m, s simulated, degrees."""

    time: float
    driven: float
    off: float  # mean error
    off_deg: float
    largest_off: float
    largest_off_deg: float

    name: ClassVar[str] = TRACKING  # its case's name

    @property
    def passed(self) -> bool:
        """Whether the mean errors are within the limits."""
        return self.off <= MOST_OFF and self.off_deg <= MOST_OFF_DEG

    @property
    def line(self) -> str:
        """A one-line summary."""
        return f"tracking: {self.off * 100:.1f} cm, {self.off_deg:.1f}° off in the mean"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"tracking, {self.time:.0f} s", f"{self.off * 100:.1f} cm, {self.off_deg:.1f}°",
                f"{MOST_OFF * 100:.0f} cm, {MOST_OFF_DEG:.0f}°",
                f"largest {self.largest_off * 100:.1f} cm, {self.largest_off_deg:.1f}°")


@dataclass(frozen=True)
class Load:
    """CPU time that amcl's process used; s."""

    particles: int
    simulated: float
    wall: float
    percent: float  # of one core: s of CPU time in 100 simulated s

    name: ClassVar[str] = LOAD  # its case's name

    @property
    def passed(self) -> bool:
        """Whether it is within the limit."""
        return self.percent <= MOST_CPU

    @property
    def line(self) -> str:
        """A one-line summary."""
        return f"load: {self.percent:.0f} % of a core"

    @property
    def row(self) -> tuple[str, str, str, str]:
        """Of the table."""
        return (f"amcl with {self.particles} particles", f"{self.percent:.0f} % of a core",
                f"{MOST_CPU:.0f} %", f"real time x{self.simulated / self.wall:.2f}")


Result = Search | Tracking | Load


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
        return found + [LocalisationCase(kind, kind, seconds=seconds) for kind, seconds in (
            (TRACKING, options.tracking), (LOAD, options.load)) if seconds]

    def drive(self, session: Session, case: LocalisationCase) -> Record:
        options = self.options
        stack = session.once(lambda: _bring_up(session, options))
        to_be_found = case.set in (FINDING, KIDNAPS)
        stack.use_odometry(by_wheels=to_be_found or options.wheel_odometry)
        return RUNS[case.set](stack, case)

    def judge(self, record: Record) -> Result:
        kind, errors = record.case.set, record.errors
        if kind in LIMITS:
            return _searched(record)
        if kind == LOAD:
            return Load(PARTICLES, record.simulated, record.wall,
                        100.0 * record.cpu / record.simulated)
        if not len(errors):
            raise RunError("amcl said no pose while it should have tracked the robot")
        (off, turn), (largest, largest_turn) = errors.mean(axis=0), errors.max(axis=0)
        return Tracking(record.case.seconds, record.driven, float(off), float(np.degrees(turn)),
                        float(largest), float(np.degrees(largest_turn)))

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


def _searched(record: Record) -> Search:
    times, errors = record.times, record.errors
    since = right_since(times, errors)
    held = since is not None and times[-1] - since >= HOLD
    off, turned = (round(float(each), 4) for each in errors[-1]) if len(errors) else (None, None)
    return Search(
        record.case.set, record.case.seed, tuple(np.round(record.start, 3).tolist()),
        round(since, 2) if held else None, off,
        turned if turned is None else round(float(np.degrees(turned)), 3), record.touched)


def _sets(results: Sequence[Result]) -> dict[str, list[Search]]:
    return grouped((each for each in results if isinstance(each, Search)), lambda each: each.set)


def _others(results: Sequence[Result]) -> list[Tracking | Load]:
    return [each for each in results if not isinstance(each, Search)]

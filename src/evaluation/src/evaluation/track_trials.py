"""`make track-trials`: many seeded drives, each like `make track FAST=1`."""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ai_robot_tracking.scenes.scene import DISTRACTORS, HIDDEN_AT, LIGHT, MOVING, OCCLUSION, STATIC

from evaluation.command_line import Parser
from evaluation.report import cell, mean, table_of
from evaluation.track import PAGE, PID
from evaluation.track_score import EARLY, FIND_TIME
from evaluation.trial import REPORT, Case, Trial
from run_session.failure import RunError
from run_session.files import find_package
from run_session.session import Session

LIMIT = 900.0  # s, wall, for one drive


@dataclass(frozen=True)
class Set:
    """Drives of one kind."""

    name: str
    scene: str
    tracker: str
    least_share: float  # of its cases that have to be good; 0: for information only
    cases: int = 1      # in each drive


SETS = {kind.name: kind for kind in (
    Set("reach", STATIC, PAGE, 1.0),
    Set("stand", STATIC, PID, 1.0),
    Set("follow", MOVING, PID, 1.0),
    Set("hidden", OCCLUSION, PID, 0.9, cases=len(HIDDEN_AT)),
    Set("light", LIGHT, PID, 0.0),
    Set("distractors", DISTRACTORS, PID, 0.0),
)}


@dataclass(frozen=True)
class DriveResult:
    """One drive's report, as `make track` writes it."""

    name: str
    set: str
    report: dict

    @property
    def good(self) -> int:
        """How many of its cases were good: periods under the hood, or the drive as a whole."""
        if SETS[self.set].scene != OCCLUSION:
            return int(self.report["good"])
        return sum(each["found_after_s"] is not None and each["found_after_s"] <= FIND_TIME
                   for each in self.report["hidden"])


COLUMNS = {
    "set": lambda each: each["set"], "scene": lambda each: each["scene"],
    "tracker": lambda each: each["tracker"],
    "good": lambda each: f"{each['good']} of {each['cases']}",
    "near after s": lambda each: cell(each["mean_approach"]),
    "RMS cm": lambda each: cell(each["mean_rms_error"], 100),
    "most cm": lambda each: cell(each["max_error"], 100),
    "settled cm": lambda each: cell(each["max_error_settled"], 100),
    "found by s": lambda each: cell(each["longest_find"]),
    "seeds not good": lambda each: ", ".join(map(str, each["failed_seeds"])) or "-"}


class TrackTrial(Trial):
    """Drives of several sets; each drive's report is in its own folder."""

    program = "track_trials"
    does = "Follow the red cylinder in many seeded drives, and count."
    good = "enough of each set good"
    writes = "report.json, report.html and the drives"

    def add_options(self, parser: Parser) -> None:
        parser.add_whole("--seeds", 20, "drives of each set, half as many of hidden (two each)")
        parser.add_whole("--first-seed", 0, "seed of the first of them")
        parser.add_argument(
            "--sets", nargs="+", choices=SETS, metavar="SET", help=f"of: {' '.join(SETS)}",
            default=[kind.name for kind in SETS.values() if kind.least_share])

    def check(self, options: argparse.Namespace) -> None:
        if options.seeds == 0:
            raise RunError("--seeds 0: nothing to drive")

    def cases(self, options: argparse.Namespace) -> list[Case]:
        first = options.first_seed
        return [Case(f"{kind.name}/{seed}", kind.name, seed)
                for kind in SETS.values() if kind.name in options.sets
                for seed in range(first, first + math.ceil(options.seeds / kind.cases))]

    def earlier(self, options: argparse.Namespace) -> list[DriveResult]:
        """The complete drives that have reports; it is no error if there are none."""
        found = [(case, _read(path)) for case in self.cases(options)
                 if (path := options.out / case.name / REPORT).exists()]
        return [DriveResult(case.name, case.set, report) for case, report in found
                if report["outcome"] != EARLY]

    def drive(self, session: Session, case: Case) -> tuple[Case, dict]:
        """The case, and the drive's report."""
        kind = SETS[case.set]
        folder = session.out / case.name
        return case, session.drive([
            sys.executable, "-P", str(find_package("evaluation") / "scripts" / "track.py"),
            "--scene", kind.scene, "--seed", str(case.seed), "--tracker", kind.tracker, "--fast",
            "--no-video", "--any-port", "--out", str(folder)], folder,
            f"{case.set}, seed {case.seed}", LIMIT)

    def judge(self, record: tuple[Case, dict]) -> DriveResult:
        case, report = record
        return DriveResult(case.name, case.set, report)

    def passed(self, results: Sequence[DriveResult]) -> bool:
        return all(each["passed"] for each in summarize(results))

    def line(self, result: DriveResult) -> str:
        report = result.report
        found = [cell(each["found_after_s"]) for each in report["hidden"]]
        hidden = f", found again after {', '.join(found)} s" if found else ""
        return (f"{result.set} {report['seed']}: {report['outcome']}, near after "
                f"{cell(report['approach_s'])} s, at most {cell(report['max_error_m'], 100)} cm"
                f" beside{hidden}, real time x{report['real_time_factor'] or 0:.2f}")

    def table(self, results: Sequence[DriveResult]) -> str:
        return table_of(COLUMNS, summarize(results), left=range(10))

    def values(self, results: Sequence[DriveResult]) -> dict:
        return {"summaries": summarize(results)}


def summarize(drives: Sequence[DriveResult]) -> list[dict]:
    """A summary for each set that was driven, in order; m, s, None if there is no figure."""
    groups = {name: [drive for drive in drives if drive.set == name] for name in SETS}
    return [_summary(SETS[name], group) for name, group in groups.items() if group]


def _summary(kind: Set, drives: list[DriveResult]) -> dict:
    reports = [drive.report for drive in drives]

    def known(key: str, reports: Sequence[dict] = reports) -> list[float]:
        return [report[key] for report in reports if report[key] is not None]

    finds = [each for report in reports for each in report["hidden"]]
    cases, good = kind.cases * len(drives), sum(drive.good for drive in drives)
    return {
        "set": kind.name, "scene": kind.scene, "tracker": kind.tracker, "cases": cases,
        "good": good, "least_share": kind.least_share,
        "mean_approach": mean(known("approach_s")), "mean_rms_error": mean(known("rms_error_m")),
        "max_error": max(known("max_error_m"), default=None),
        "max_error_settled": max(known("max_error_settled_m"), default=None),
        "longest_find": max(known("found_after_s", finds), default=None),
        "least_gap": min(known("least_gap_m"), default=None),
        "failed_seeds": [drive.report["seed"] for drive in drives if drive.good < kind.cases],
        "passed": good >= kind.least_share * cases}


def _read(path: Path) -> dict:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise RunError(f"{path}: no report of a drive ({error}); remove it, or --resume not"
                       ) from error

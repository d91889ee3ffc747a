"""`make track-trials`: many seeded drives, one after the other, each as `make track FAST=1`."""

from __future__ import annotations

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from evaluation.command_line import Parser, whole
from evaluation.course_run.course_file import find_package
from evaluation.course_run.failure import RunError
from evaluation.course_run.processes import Child, Family
from evaluation.program import NOT_PASSED, PASSED, run_program
from evaluation.tracking.course import PAGE, PID
from evaluation.tracking.scene import DISTRACTORS, HIDDEN_AT, LIGHT, MOVING, OCCLUSION, STATIC
from evaluation.tracking.score import FIND_TIME

LIMIT = 900.0  # s, wall, for one drive
DRIVEN = (0, 1)  # exit codes of track.py after a drive


@dataclass(frozen=True)
class Set:
    """Drives of one kind."""

    name: str
    scene: str
    tracker: str
    least_share: float  # of its cases that have to be good; 0: only to be looked at
    cases: int = 1      # in each drive


SETS = (
    Set("reach", STATIC, PAGE, 1.0),
    Set("stand", STATIC, PID, 1.0),
    Set("follow", MOVING, PID, 1.0),
    Set("hidden", OCCLUSION, PID, 0.9, cases=len(HIDDEN_AT)),
    Set("light", LIGHT, PID, 0.0),
    Set("distractors", DISTRACTORS, PID, 0.0),
)


@dataclass(frozen=True)
class Summary:
    """All drives of a set; m, s."""

    set: str
    scene: str
    tracker: str
    cases: int
    good: int
    least_share: float
    mean_approach: float | None
    mean_rms_error: float | None
    max_error: float | None
    max_error_settled: float | None  # later than a moment after it was near
    longest_find: float | None
    least_gap: float | None
    failed_seeds: list[int]

    @property
    def passed(self) -> bool:
        """Whether enough of its cases were good."""
        return self.good >= self.least_share * self.cases


def good_cases(report: dict, kind: Set) -> int:
    """How many of a drive's cases were good: times hidden, or the drive."""
    if kind.scene != OCCLUSION:
        return int(report["good"])
    return sum(each["found_after_s"] is not None and each["found_after_s"] <= FIND_TIME
               for each in report["hidden"])


def summarize(kind: Set, reports: Sequence[dict]) -> Summary:
    """One set's drives together."""
    def known(key: str) -> list[float]:
        return [report[key] for report in reports if report[key] is not None]

    found = [each["found_after_s"] for report in reports for each in report["hidden"]
             if each["found_after_s"] is not None]
    return Summary(
        kind.name, kind.scene, kind.tracker, kind.cases * len(reports),
        sum(good_cases(report, kind) for report in reports), kind.least_share,
        _mean(known("approach_s")), _mean(known("rms_error_m")),
        max(known("max_error_m"), default=None),
        max(known("max_error_settled_m"), default=None), max(found, default=None),
        min(known("least_gap_m"), default=None),
        [report["seed"] for report in reports if good_cases(report, kind) < kind.cases],
    )  # fmt: skip


def table(summaries: Sequence[Summary]) -> str:
    """A row each."""
    rows = [("set", "scene", "tracker", "good", "near after s", "RMS cm", "most cm", "settled cm",
             "found by s",
             "seeds not good")]  # fmt: skip
    rows += [(each.set, each.scene, each.tracker, f"{each.good} of {each.cases}",
              _cell(each.mean_approach, 1, 1), _cell(each.mean_rms_error, 100, 1),
              _cell(each.max_error, 100, 1), _cell(each.max_error_settled, 100, 1),
              _cell(each.longest_find, 1, 1),
              ", ".join(map(str, each.failed_seeds)) or "-") for each in summaries]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
                     .rstrip() for row in rows)


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("track_trials", lambda: _run(_parser().parse_args(arguments)))


def _parser() -> Parser:
    names = " ".join(kind.name for kind in SETS)
    parser = Parser(
        prog="track_trials.py",
        description="Follow the red cylinder in many seeded drives, and count.",
        epilog="Exit code: 0 enough of each set good, 1 not so, 2 could not run.")
    add = parser.add_argument
    add("--seeds", default="20", metavar="N",
        help="drives of each set, half as many of hidden, which hides it twice a drive (20)")
    add("--first-seed", default="0", metavar="N", help="seed of the first of them (0)")
    add("--sets", nargs="+", default=[kind.name for kind in SETS if kind.least_share],
        choices=[kind.name for kind in SETS], metavar="SET", help=f"of: {names}")
    add("--resume", action="store_true", help="go on where the run that wrote there ended")
    add("--out", type=Path, default=Path("out/track_trials"), metavar="DIR",
        help="where report.json and the drives go (out/track_trials)")
    return parser


def _run(given: argparse.Namespace) -> int:
    seeds, first = whole("--seeds (SEEDS=)", given.seeds), whole("--first-seed", given.first_seed)
    if seeds == 0:
        raise RunError("--seeds 0: nothing to drive")
    chosen = [kind for kind in SETS if kind.name in given.sets]
    out = given.out.resolve()
    summaries = []
    for kind in chosen:
        reports = []
        for seed in range(first, first + math.ceil(seeds / kind.cases)):
            folder = out / kind.name / str(seed)
            reports.append(_drive(kind, seed, folder, given.resume))
            print(f"{kind.name} {seed}: {_line(reports[-1])}", flush=True)
        summaries.append(summarize(kind, reports))
        values = {"summaries": [{**asdict(each), "passed": each.passed} for each in summaries]}
        (out / "report.json").write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    print(table(summaries), flush=True)
    print(f"written to {out}: report.json, and a folder for each drive", flush=True)
    return PASSED if all(each.passed for each in summaries) else NOT_PASSED


def _drive(kind: Set, seed: int, folder: Path, resume: bool) -> dict:
    """The report of one drive below its folder; RunError if it could not be driven."""
    report = folder / "report.json"
    if not (resume and report.exists()):
        folder.mkdir(parents=True, exist_ok=True)
        report.unlink(missing_ok=True)
        command = [
            sys.executable, "-P", str(find_package("evaluation") / "scripts" / "track.py"),
            "--scene", kind.scene, "--seed", str(seed), "--tracker", kind.tracker, "--fast",
            "--no-video", "--out", str(folder),
        ]  # fmt: skip
        try:
            with Family() as family:
                child = family.start("track", command, os.environ, folder / "track.log")
                _wait(child)
        except (KeyboardInterrupt, RunError):
            report.unlink(missing_ok=True)  # half a drive must not be taken for one by --resume
            raise
        if child.process.returncode not in DRIVEN or not report.exists():
            *details, why = child.last_lines().splitlines() or ["track.py said nothing"]
            raise RunError(f"{kind.name}, seed {seed}: {why}", "\n".join(details))
    try:
        return json.loads(report.read_text(encoding="utf-8"))
    except ValueError as error:
        raise RunError(f"{report}: no report of a drive ({error}); remove it, or --resume not"
                       ) from error


def _wait(child: Child) -> None:
    try:
        child.process.wait(LIMIT)
    except subprocess.TimeoutExpired as late:
        raise RunError(f"a drive did not end within {LIMIT:.0f} s", child.last_lines()) from late


def _line(report: dict) -> str:
    found = [_cell(each["found_after_s"], 1, 1) for each in report["hidden"]]
    hidden = f", found again after {', '.join(found)} s" if found else ""
    return (f"{report['outcome']}, near after {_cell(report['approach_s'], 1, 1)} s, at most "
            f"{_cell(report['max_error_m'], 100, 1)} cm beside{hidden}, "
            f"real time x{report['real_time_factor'] or 0:.2f}")


def _mean(values: list[float]) -> float | None:
    return statistics.fmean(values) if values else None


def _cell(value: float | None, factor: float, digits: int) -> str:
    return "-" if value is None else f"{value * factor:.{digits}f}"

"""The command lines of lane_trials and bench_lanes, checked: a mistake is one line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import lane_keeping.methods

from evaluation.command_line import Parser, whole
from evaluation.course_run.failure import RunError


@dataclass(frozen=True)
class TrialOptions:
    """What lane_trials drives and where it writes."""

    method: str
    seeds: range  # of single laps without people
    crossings: int  # encounters with people
    out: Path
    resume: bool  # drive only what report.json in `out` has not


@dataclass(frozen=True)
class BenchOptions:
    """What bench_lanes drives and where it writes."""

    methods: tuple[str, ...]
    seeds: range
    out: Path
    resume: bool


def parse_trials(arguments: list[str]) -> TrialOptions:
    """Options from the command line, or RunError."""
    parser = _parser("lane_trials.py", "Drive laps in differing light and past people.")
    parser.add_argument("--seeds", default="20", metavar="N", help="laps without people (20)")
    parser.add_argument("--crossings", default="100", metavar="N", help="people to meet (100)")
    parser.add_argument("--method", default="sliding_windows", help="(sliding_windows)")
    _add_common(parser, "out/lane_trials")
    given = parser.parse_args(arguments)
    _check_methods([given.method])
    seeds, crossings = whole("--seeds", given.seeds), whole("--crossings", given.crossings)
    if not seeds and not crossings:
        raise RunError("--seeds 0 --crossings 0: nothing to drive")
    return TrialOptions(given.method, range(seeds), crossings, given.out.resolve(), given.resume)


def parse_bench(arguments: list[str]) -> BenchOptions:
    """Options from the command line, or RunError."""
    parser = _parser("bench_lanes.py", "Compare all methods on the same seeds.")
    parser.add_argument("--seeds", default="5", metavar="N", help="laps of each method (5)")
    parser.add_argument("--methods", nargs="+", metavar="NAME", help="some of them (all)")
    _add_common(parser, "out/bench_lanes")
    given = parser.parse_args(arguments)
    methods = tuple(dict.fromkeys(given.methods or known_methods()))
    _check_methods(methods)
    seeds = range(whole("--seeds", given.seeds))
    if not seeds:
        raise RunError("--seeds 0: nothing to drive")
    return BenchOptions(methods, seeds, given.out.resolve(), given.resume)


def known_methods() -> list[str]:
    """Names of all methods; sliding_windows comes first."""
    folders = (Path(folder) for folder in lane_keeping.methods.__path__)
    names = sorted(path.stem for folder in folders for path in folder.glob("*.py")
                   if "def plan" in path.read_text(encoding="utf-8"))
    return sorted(names, key=lambda name: name != "sliding_windows")


def _parser(name: str, does: str) -> Parser:
    return Parser(prog=name, description=does,
                  epilog="Exit code: 0 all within the limits, 1 some not, 2 could not run.")


def _add_common(parser: Parser, out: str) -> None:
    parser.add_argument("--out", type=Path, default=Path(out), metavar="DIR",
                        help=f"where report.json and the drives go ({out})")
    parser.add_argument("--resume", action="store_true",
                        help="go on where the run that wrote there ended")


def _check_methods(methods: list[str] | tuple[str, ...]) -> None:
    known = known_methods()
    for name in methods:
        if name not in known:
            raise RunError(f"no method {name!r} (METHOD=); there are: {', '.join(known)}")

"""The command line of navigation_trials, checked: a mistake is one line that says what to type."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.command_line import Parser, pace, whole
from evaluation.course_run.course_file import find_package
from evaluation.course_run.failure import RunError

PARAMETERS = Path("config") / "yard.yaml"


@dataclass(frozen=True)
class Options:
    """What to drive and where to write."""

    yards: range
    repeats: int
    crossings: range
    real_time_factor: float
    parameters: Path  # of move_base, over TurtleBot3's
    out: Path
    resume: bool  # drive only what report.json in `out` has not


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    first_yard = whole("--first-yard", given.first_yard)
    first_crossing = whole("--first-crossing", given.first_crossing)
    yards = range(first_yard, first_yard + whole("--yards", given.yards))
    crossings = range(first_crossing, first_crossing + whole("--crossings", given.crossings))
    repeats = whole("--repeats", given.repeats)
    if not (yards and repeats) and not crossings:
        raise RunError("no yards or repeats, and no crossings: nothing to drive")
    parameters = (given.parameters or find_package("evaluation") / PARAMETERS).resolve()
    if not parameters.is_file():
        raise RunError(f"--parameters {parameters}: no such file")
    return Options(yards, repeats, crossings, pace(given.real_time_factor), parameters,
                   given.out.resolve(), given.resume)


def _parser() -> Parser:
    parser = Parser(
        prog="navigation_trials.py",
        description="Drive the waffle by move_base, without a map, through narrow yards and past"
        " persons who cross its way.",
        epilog="Exit code: 0 at least 95 %% of the yards crossed and no person touched, 1 not so,"
        " 2 could not run.",
    )
    add = parser.add_argument
    add("--yards", default="50", metavar="N", help="narrow worlds (50)")
    add("--first-yard", default="0", metavar="N", help="seed of the first of them (0)")
    add("--repeats", default="2", metavar="N", help="drives through each of them (2)")
    add("--crossings", default="20", metavar="N", help="drives past a person (20)")
    add("--first-crossing", default="0", metavar="N", help="seed of the first of them (0)")
    add("--real-time-factor", default="1", metavar="X",
        help="how fast simulated time shall go (1)")
    add("--parameters", type=Path, metavar="FILE",
        help=f"of move_base, over turtlebot3_navigation's (evaluation/{PARAMETERS})")
    add("--out", type=Path, default=Path("out/navigation_trials"), metavar="DIR",
        help="where report.json, pictures, worlds and drives go (out/navigation_trials)")
    add("--resume", action="store_true", help="go on where the run that wrote there ended")
    return parser

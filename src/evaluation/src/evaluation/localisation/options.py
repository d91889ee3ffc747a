"""The command line of localisation_trials, checked: a mistake is one line with what to type."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.command_line import Parser, pace, whole
from evaluation.course_run.failure import RunError
from evaluation.navigation.house_file import House, load_house


@dataclass(frozen=True)
class Options:
    """What to try and where to write."""

    house: House
    starts: range  # numbers of the trials
    kidnaps: range
    tracking: int  # s, simulated; 0: none
    load: int  # s, simulated; 0: none
    wheel_odometry: bool  # also while it is tracked
    seed: int
    real_time_factor: float
    out: Path


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    starts, kidnaps, tracking, load = (whole(f"--{name}", getattr(given, name))
                                       for name in ("starts", "kidnaps", "tracking", "load"))
    first = whole("--first", given.first)
    if not (starts or kidnaps or tracking or load):
        raise RunError("no starts, no kidnaps, no tracking and no load: nothing to try")
    return Options(load_house(given.house), range(first, first + starts),
                   range(first, first + kidnaps), tracking, load, given.wheel_odometry,
                   whole("--seed", given.seed), pace(given.real_time_factor),
                   given.out.resolve())


def _parser() -> Parser:
    parser = Parser(
        prog="localisation_trials.py",
        description="Have amcl find the waffle in the house: from anywhere, and after it was"
        " carried away; then have it keep track of it, and see what that costs.",
        epilog="Exit code: 0 all within the limits of the table, 1 not so, 2 could not run.",
    )
    add = parser.add_argument
    add("--starts", default="20", metavar="N", help="robots to find anywhere in the house (20)")
    add("--kidnaps", default="10", metavar="N", help="robots to find that were carried away (10)")
    add("--first", default="1", metavar="N", help="number of the first of each (1)")
    add("--tracking", default="300", metavar="S", help="simulated seconds to track for (300)")
    add("--load", default="60", metavar="S", help="simulated seconds of 2000 particles (60)")
    add("--wheel-odometry", action="store_true", help="track by the wheels' odometry, too, which"
        " slips in turns: robots that are to be found always have it, a simulated TurtleBot3 has"
        " the truth")
    add("--seed", default="0", metavar="N", help="of places, ways, noise and particles (0)")
    add("--house", default="house", metavar="NAME", help="a house of houses/, or a file (house)")
    add("--real-time-factor", default="1", metavar="X",
        help="simulated seconds a second; the load is always measured at 1 (1)")
    add("--out", type=Path, default=Path("out/localisation_trials"), metavar="DIR",
        help="where report.json, the map and log/ go (out/localisation_trials)")
    return parser

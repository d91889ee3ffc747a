"""The command line of navigate, checked: a mistake is one line that says what to type instead."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.house.house_file import House, load_house
from evaluation.session.failure import RunError
from evaluation.trial.command_line import Parser, pace, whole


@dataclass(frozen=True)
class Options:
    """What to run and where to write."""

    house: House
    goals: int
    seed: int  # of noise, goals and the error of the pose that localisation is told
    real_time_factor: float  # simulated seconds a second
    out: Path
    map: Path | None  # a map to navigate on; None: make one
    video: bool
    startup_timeout: float  # s, wall
    stuck_timeout: float  # s, wall


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    if given.map is not None and not given.map.exists():
        raise RunError(f"--map {given.map}: no such file; it is a map's NAME.yaml")
    return Options(
        load_house(given.house),
        whole("--goals (GOALS=)", given.goals, least=1),
        whole("--seed (SEED=)", given.seed, most=999_999_999),
        pace(given.real_time_factor),
        given.out.resolve(),
        given.map.resolve() if given.map else None,
        given.video,
        given.startup_timeout,
        given.stuck_timeout,
    )


def _parser() -> Parser:
    parser = Parser(
        prog="navigate.py",
        description="Map a house, start again on that map, visit goals in it; all without a"
        " screen. Scores map, localisation and driving, writes a report.",
        epilog="Exit code: 0 all goals reached, nothing touched, map and localisation within their"
        " limits; 1 not so; 2 could not run.",
    )
    add = parser.add_argument
    add("--goals", default="5", metavar="N", help="goals to visit, drawn from the seed (5)")
    add("--seed", default="0", metavar="N", help="of noise, goals and the first pose (0)")
    add("--real-time-factor", default="1", metavar="X",
        help="simulated seconds a second; below 1 on a slow machine (1)")
    add("--house", default="house", metavar="NAME", help="a house of houses/, or a file (house)")
    add("--map", type=Path, metavar="YAML", help="no mapping round: navigate on this map, which"
        " was made by a run with the same house")
    add("--out", type=Path, default=Path("out/navigate"), metavar="DIR",
        help="where map.png, run.mp4, report.json, map.yaml and log/ go (out/navigate)")
    add("--no-video", dest="video", action="store_false", help="write no run.mp4")
    add("--startup-timeout", type=float, default=90.0, metavar="S",
        help="wall seconds for what is started to be there (90)")
    add("--stuck-timeout", type=float, default=30.0, metavar="S",
        help="wall seconds that simulated time may stand still (30)")
    return parser

"""The command line of race_trials, checked: a mistake is one line that says what to type."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.command_line import Parser, whole
from evaluation.course_run.failure import RunError

LARGEST_SEED = 100_000_000  # a larger one is none for course_run
FOLLOWERS = ("lane_follow.py", "lane_follow_p.py")


@dataclass(frozen=True)
class Options:
    """What to drive and where to write."""

    seeds: range  # of laps on the racetrack
    tracks: range  # of random tracks; each also seeds the one lap there
    followers: tuple[str, ...]  # the first is the one that must pass
    out: Path
    resume: bool  # drive only what report.json in `out` has not


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    first_seed = whole("--first-seed", given.first_seed, most=LARGEST_SEED)
    first_track = whole("--first-track", given.first_track, most=LARGEST_SEED)
    seeds = range(first_seed, first_seed + whole("--seeds", given.seeds))
    tracks = range(first_track, first_track + whole("--tracks", given.tracks))
    if not seeds and not tracks:
        raise RunError("--seeds 0 --tracks 0: nothing to drive")
    followers = tuple(dict.fromkeys(given.followers))
    return Options(seeds, tracks, followers, given.out.resolve(), given.resume)


def _parser() -> Parser:
    parser = Parser(
        prog="race_trials.py",
        description="Drive many laps, each with a start, camera noise and light of its own; compare"
        " followers.",
        epilog="Exit code: 0 all laps of the first follower closed within the limits, 1 some not,"
        " 2 could not run.",
    )
    add = parser.add_argument
    add("--seeds", default="20", metavar="N", help="laps on the racetrack (20)")
    add("--first-seed", default="0", metavar="N", help="seed of the first of them (0)")
    add("--tracks", default="10", metavar="N", help="random tracks, a lap on each (10)")
    add("--first-track", default="101", metavar="N", help="seed of the first of them (101)")
    add(
        "--followers", nargs="+", default=FOLLOWERS, metavar="FILE",
        help=f"scripts of car_control; the first must pass ({' '.join(FOLLOWERS)})",
    )  # fmt: skip
    add(
        "--out", type=Path, default=Path("out/race_trials"), metavar="DIR",
        help="where report.json, trials.png and the laps go (out/race_trials)",
    )  # fmt: skip
    add("--resume", action="store_true", help="go on where the run that wrote there ended")
    return parser

"""The command line of `make track`, checked: a mistake is one line that says what to type."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from evaluation.session.failure import RunError
from evaluation.tracking.course import COURSE, PID, TRACKERS
from evaluation.tracking.scene import KINDS, MOVING
from evaluation.trial.command_line import Parser, number, whole


@dataclass(frozen=True)
class Options:
    """What to drive and where to write."""

    scene: str
    seed: int
    tracker: str
    keep: float  # s that the distance is to be kept
    fast: bool
    video: bool
    out: Path
    startup_timeout: float  # s, wall
    stuck_timeout: float  # s, wall


def parse_options(arguments: list[str]) -> Options:
    """Options from the command line, or RunError."""
    given = _parser().parse_args(arguments)
    if given.scene not in KINDS:
        raise RunError(f"no scene {given.scene!r} (SCENE=); there are: {', '.join(KINDS)}")
    if given.tracker not in TRACKERS:
        raise RunError(f"no tracker {given.tracker!r} (TRACKER=); there are: {', '.join(TRACKERS)}")
    return Options(given.scene, whole("--seed (SEED=)", given.seed), given.tracker,
                   number("--keep", given.keep, 1, 150, "seconds"), given.fast, given.video,
                   given.out.resolve(), 90.0, 30.0)


def _parser() -> Parser:
    parser = Parser(
        prog="track.py",
        description="Follow the red cylinder without a screen, score it, write a report.",
        epilog="Exit code: 0 all that was asked for was seen, 1 not so, 2 could not run.")
    add = parser.add_argument
    add("--scene", default=MOVING, metavar="NAME", help=f"{', '.join(KINDS)} ({MOVING})")
    add("--seed", default="0", metavar="N", help="of the cylinder's way, the start, the noise (0)")
    add("--tracker", default=PID, metavar="FILE", help=f"{' or '.join(TRACKERS)} ({PID})")
    add("--keep", default="60", metavar="S", help="simulated seconds to keep the distance (60)")
    add("--fast", action="store_true",
        help="as fast as the machine goes: after each image the world waits for the tracker")
    add("--no-video", dest="video", action="store_false", help="write no run.mp4")
    add("--out", type=Path, default=Path(COURSE.out), metavar="DIR",
        help=f"where path.png, run.mp4, report.json and log/ go ({COURSE.out})")
    return parser

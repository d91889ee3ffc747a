"""The command: list the exercises, or check a file."""

from __future__ import annotations

import argparse
import importlib
import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import rospkg
from node_basics.ending import interruptible
from terminal_language.wanted import wanted_language

from bullet_sim import __version__
from bullet_sim.errors import did_you_mean
from exercises.catalogue import MODULES, Exercise, find_exercises
from exercises.finding import CannotCheck, Finding, Mistake, TimeUp
from exercises.program import line_in, said
from run_session.failure import RunError

PASSED, FAILED, COULD_NOT, INTERRUPTED = 0, 1, 2, 130
LIMIT = 300  # s, wall: of one check
LONG = 15.0  # s, wall, after which a check says that it goes on
EPILOG = "Exit code 0: passed; 1: failed; 2: could not be checked; 130: interrupted."


def run() -> int:
    """`main` for a terminal: Ctrl-C and the time limit end a check that hangs."""
    signal.signal(signal.SIGALRM, _give_up)
    signal.alarm(LIMIT)
    waiting = threading.Timer(LONG, _still_checking)
    waiting.daemon = True
    waiting.start()
    try:
        with interruptible():
            return main()
    except TimeUp:
        print(f"check_exercise: not done after {LIMIT} s: does a loop of the program never end?",
              file=sys.stderr)
        return COULD_NOT
    except KeyboardInterrupt:
        return INTERRUPTED
    finally:
        waiting.cancel()


def main(arguments: list[str] | None = None) -> int:
    """The exit code."""
    parser = argparse.ArgumentParser(
        prog="check_exercise", description=__doc__, epilog=EPILOG)
    parser.add_argument("name", nargs="?", help="of the exercise; without it: list all")
    parser.add_argument("file", nargs="?", type=Path, help="yours (default: the exercise's own)")
    parser.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    options = parser.parse_args(arguments)
    try:
        known = find_exercises()
        if options.name is None:
            return list_all(known)
        return check(chosen(known, options.name), options.file)
    except (CannotCheck, RunError) as error:
        print(f"check_exercise: {error}", file=sys.stderr)
        return COULD_NOT


def list_all(known: dict[str, Exercise]) -> int:
    """Print name, title and file of each exercise; returns the exit code."""
    width = max(map(len, known), default=0)
    for name, exercise in known.items():
        print(f"{name:{width}}  {title(exercise)}  ({shown(exercise.start)})")
    print("Check one: rosrun exercises check_exercise NAME")
    return PASSED


def chosen(known: dict[str, Exercise], name: str) -> Exercise:
    """The exercise of that name; if there is none, CannotCheck lists all."""
    if name not in known:
        given = repr(name) + did_you_mean(name, known, 0.75)
        raise CannotCheck(f"no exercise {given}; there are: {', '.join(known)}")
    return known[name]


def title(exercise: Exercise) -> str:
    """In the terminal's language, if the title has two, with two spaces between them."""
    english, _, chinese = exercise.title.partition("  ")
    return chinese.strip() if chinese and wanted_language(dict(os.environ)) else english


def check(exercise: Exercise, file: Path | None = None) -> int:
    """Print a line for each finding; returns the exit code."""
    file = file or exercise.start
    if not file.is_file():
        raise CannotCheck(f"{file}: no such file; leave FILE out to check {exercise.start}")
    print(f"{title(exercise)}  ({shown(file)})", flush=True)
    failed, count = 0, 0
    try:
        for finding in findings(exercise, file):
            print(finding, flush=True)
            count, failed = count + 1, failed + (not finding.passed)
    except Mistake as mistake:
        print(f"FAIL  {mistake}")
        return FAILED
    print(f"{failed} of {count} checks failed: the lesson's README has hints" if failed
          else f"passed, {count} of {count}")
    return FAILED if failed else PASSED


def findings(exercise: Exercise, file: Path) -> Iterator[Finding]:
    """The findings of the exercise's check on a file; Mistake if the learner's program fails."""
    module = next(name for name, checks in MODULES.items() if exercise.check in checks)
    check = getattr(importlib.import_module(f"exercises.checks.{module}"), exercise.check)
    try:
        yield from check(file.resolve(), exercise.limits)
    except (CannotCheck, Mistake, RunError):
        raise
    except (Exception, SystemExit) as error:
        if line_in(error, file.resolve()) is not None:
            raise Mistake(said(error, file.resolve())) from error
        if isinstance(error, (AttributeError, TypeError)):  # the learner changed what it calls
            raise Mistake(f"{file}: {error}: keep names, arguments and answers as in the starting"
                          " file") from error
        raise


def shown(path: Path) -> str:
    """The path as PACKAGE/REST if it is in a package."""
    package = rospkg.get_package_name(str(path.resolve()))
    folder = Path(rospkg.RosPack().get_path(package)) if package else None
    if folder and path.resolve().is_relative_to(folder.resolve()):
        return f"{package}/{path.resolve().relative_to(folder.resolve())}"
    return str(path)


def _still_checking() -> None:
    print(f"check_exercise: not done after {LONG:g} s, and ends after {LIMIT} s at the latest; "
          "does a loop of the program never end? Ctrl-C ends it now", file=sys.stderr)


def _give_up(_number: int, _frame: object) -> None:
    raise TimeUp

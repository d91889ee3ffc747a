"""The programs' command lines, exit codes and errors: one line that says what to type instead."""

from __future__ import annotations

import argparse
import contextlib
import errno
import fcntl
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path

from node_basics.ending import interruptible
from racecar_description.track.errors import TrackError

from bullet_sim import __version__
from run_session.failure import RunError
from run_session.files import disk_of
from trial_worlds.errors import WorldError

MOST = 999_999          # largest count or seed
LARGEST_SEED = 999_999_999
LEAST_PACE, MOST_PACE = 0.01, 20.0  # no machine can keep up with more
LOCKS = Path("/proc/locks")


class Parser(argparse.ArgumentParser):
    """Accepts no abbreviated options; its errors are RunErrors."""

    def __init__(self, package: str = "evaluation", **settings: object) -> None:
        super().__init__(**{"allow_abbrev": False, **settings})
        self.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
        self._package = package  # to which the program belongs; empty: it is a script in scripts/

    def error(self, message: str) -> None:
        """Raise a RunError that says where the options are listed."""
        start = f"rosrun {self._package} " if self._package else "scripts/"
        raise RunError(f"{message} (see: {start}{self.prog.split()[0]} --help)")  # without a verb

    def add_whole(self, flag: str, default: int | None, text: str, *, variable: str | None = None,
                  least: int = 0, most: int = MOST) -> None:
        """Add an integer option; `variable`: its name in the Makefile, if not the option's word."""
        variable = flag[2:].upper() if variable is None else variable
        name = flag if "-" in variable or not variable else f"{flag} ({variable}=)"
        self.add_argument(
            flag, type=partial(whole, name, least=least, most=most), default=default, metavar="N",
            help=f"{text} ({default or 0})")

    def add_pace(self, text: str) -> None:
        """Add --real-time-factor, simulated seconds per second."""
        self.add_argument(
            "--real-time-factor", metavar="X", default=1.0, help=text, type=partial(
                number, "--real-time-factor (PACE=)", least=LEAST_PACE, most=MOST_PACE))

    def add_out(self, default: str, text: str) -> None:
        """Add --out, a folder."""
        self.add_argument("--out", type=Path, default=Path(default), metavar="DIR",
                          help=f"where {text} go ({default})")


def whole(name: str, text: str, least: int = 0, most: int = MOST) -> int:
    """A whole number written in digits, or RunError."""
    if not re.fullmatch(r"[0-9]{1,9}", text) or not least <= int(text) <= most:
        raise RunError(f"{name} must be a whole number, {least} to {most}; got {text!r}")
    return int(text)


def number(name: str, text: str, least: float, most: float, what: str = "a number") -> float:
    """A number written without an exponent, or RunError; `what` names it and its unit."""
    if not re.fullmatch(r"[0-9]{1,9}(\.[0-9]{1,6})?", text) or not least <= float(text) <= most:
        raise RunError(f"{name} must be {what}, {least:g} to {most:g}; got {text!r}")
    return float(text)


def one_of(kind: str, variable: str, names: Iterable[str], name: str) -> str:
    """The name, or RunError that lists the known ones; `variable` is its name in the Makefile."""
    known = tuple(names)
    if name not in known:
        raise RunError(f"no {kind} {name!r} ({variable}=); there are: {', '.join(known) or 'none'}")
    return name


# By program: which of the options that all trials have make takes, and how
BY_MAKE = {"mark": {"out": "OUT=", "resume": "RESUME=1"}, "grade": {"out": "OUT="},
           "replay": {"out": "OUT="}}


def option_of(program: str, word: str) -> str:
    """A trial's option as messages name it, with that of make if it takes it."""
    by_make = BY_MAKE.get(program, {}).get(word)
    return f"--{word} ({by_make})" if by_make else f"--{word}"


def elsewhere(program: str) -> str:
    """What to type for another folder of results; the script takes all options, make does not."""
    name = re.sub("_(run|drive)$", "", program)
    script = f"scripts/{name}.sh --out DIR"
    return f"make {name} OUT=DIR ({script})" if "out" in BY_MAKE.get(name, {}) else script


PASSED, NOT_PASSED, NOT_RUN, INTERRUPTED = 0, 1, 2, 130


SAID = (errno.ENOSPC, errno.EACCES, errno.EPERM)  # of an OSError, which run_program explains


def run_program(name: str, work: Callable[[], int]) -> int:
    """Do the work; returns its exit code, or prints the error and returns another."""
    try:
        with interruptible():
            return work()
    except PermissionError as refused:
        complain(name, RunError(
            f"you may not write {refused.filename}: cd to a folder of yours, or give one: "
            f"{elsewhere(name)}") if refused.filename else refused)
        return NOT_RUN
    except (RunError, TrackError, WorldError, OSError) as failure:
        if isinstance(failure, OSError) and failure.errno == errno.ENOSPC:
            file, disk = failure.filename or "what is written", "the disk"
            if failure.filename:
                disk = str(disk_of(Path(file)))
            failure = RunError(f"no space left on {disk} for {file}: make room, or give a folder "
                               f"elsewhere: {elsewhere(name)}")
        complain(name, failure)
        return NOT_RUN
    except KeyboardInterrupt:
        print(f"{name}: interrupted; all processes ended", file=sys.stderr)
        return INTERRUPTED


@contextlib.contextmanager
def results_folder(program: str, out: Path) -> Iterator[None]:
    """Makes the folder; of several runs, one is in here at a time: RunError for the others.

    The kernel releases the lock when its process dies.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
        lock = os.open(out, os.O_DIRECTORY)
    except OSError as error:
        if error.errno in SAID:
            raise
        raise RunError(f"{option_of(program, 'out')} {out}: {error.strerror}") from error
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise RunError(f"{out} is being written by another run (PID {_writer(lock)}): end it, "
                           f"or give a folder elsewhere: {elsewhere(program)}") from None
        except OSError:  # a network's file system, which cannot lock folders
            pass
        yield
    finally:
        os.close(lock)


def _writer(folder: int) -> str:
    """The process that has locked this open folder; "?": it has just ended, or is not shown."""
    node = str(os.fstat(folder).st_ino)
    with contextlib.suppress(OSError):  # a sandbox may have no /proc/locks
        for line in LOCKS.read_text(encoding="ascii").splitlines():
            words = line.split()
            if words[1] == "FLOCK" and words[5].rpartition(":")[2] == node:
                return words[4]
    return "?"


def complain(name: str, failure: Exception) -> None:
    """Print the failure's details, if any, then its one line."""
    if details := getattr(failure, "details", ""):
        print(details, file=sys.stderr)
    print(f"{name}: {failure}", file=sys.stderr)

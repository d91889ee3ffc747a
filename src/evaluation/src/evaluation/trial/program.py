"""Shared by the programs: exit codes, and errors printed as one line."""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable

from racecar_description.track.errors import TrackError

from run_session.failure import RunError
from run_session.interruption import interruptible
from trial_worlds.errors import WorldError

PASSED, NOT_PASSED, NOT_RUN, INTERRUPTED = 0, 1, 2, 130


def run_program(name: str, work: Callable[[], int]) -> int:
    """Do the work; returns its exit code, or prints the error and returns another."""
    try:
        with interruptible():
            return work()
    except PermissionError as refused:
        complain(name, RunError(f"you may not write {refused.filename}: cd to a folder of yours, "
                                "or give one with --out") if refused.filename else refused)
        return NOT_RUN
    except (RunError, TrackError, WorldError, OSError) as failure:
        full = isinstance(failure, OSError) and failure.errno == errno.ENOSPC
        complain(name, RunError(f"no space left for {failure.filename or 'what is written'}: make "
                                "room, or give a folder elsewhere with --out") if full else failure)
        return NOT_RUN
    except KeyboardInterrupt:
        print(f"{name}: interrupted; all processes ended", file=sys.stderr)
        return INTERRUPTED


def complain(name: str, failure: Exception) -> None:
    """Print the failure's details, if any, then its one line."""
    if details := getattr(failure, "details", ""):
        print(details, file=sys.stderr)
    print(f"{name}: {failure}", file=sys.stderr)

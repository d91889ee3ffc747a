"""What the lane's programs share: exit codes, and one line for each thing that goes wrong."""

from __future__ import annotations

import sys
from collections.abc import Callable

from evaluation.course_run.failure import RunError
from evaluation.course_run.interruption import interruptible
from evaluation.track import TrackError

PASSED, NOT_PASSED, NOT_RUN, INTERRUPTED = 0, 1, 2, 130


def run_program(name: str, work: Callable[[], int]) -> int:
    """Do the work; returns its exit code, or says what went wrong and returns another."""
    try:
        with interruptible():
            return work()
    except (RunError, TrackError, OSError) as failure:
        if getattr(failure, "details", ""):
            print(failure.details, file=sys.stderr)
        print(f"{name}: {failure}", file=sys.stderr)
        return NOT_RUN
    except KeyboardInterrupt:
        print(f"{name}: interrupted; all processes ended", file=sys.stderr)
        return INTERRUPTED

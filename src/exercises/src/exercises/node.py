"""Runs a learner's file as a node on its own master; this process is another node."""

from __future__ import annotations

import contextlib
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import rospy

from exercises.finding import Mistake
from exercises.program import compiled
from run_session.launch import Launched, describe_exit
from run_session.processes import Child, Family

START = 20.0  # s, wall: for the node's first topic or service
PAUSE = 0.05  # s


@contextlib.contextmanager
def running(file: Path) -> Iterator[Callable[[Callable[[], object], float], bool]]:
    """While the node runs: a function that waits (at most s) for a condition; True if it holds.

    CannotCheck if it is no Python, RunError if no roscore starts; the function raises Mistake if
    the node has ended.
    """
    compiled(file)
    with tempfile.TemporaryDirectory() as folder, Family() as family:
        launched = Launched(family, Path(folder) / "log")
        launched.start_roscore()
        rospy.init_node("check_exercise", disable_signals=True, disable_rosout=True)
        child = launched.start("exercise", [sys.executable, str(file)])
        try:
            yield lambda condition, limit: wait(file, child, condition, limit)
        finally:
            rospy.signal_shutdown("checked")


def wait(file: Path, child: Child, condition: Callable[[], object], limit: float) -> bool:
    """Whether the condition holds within `limit`, s, wall; Mistake if the node ends before."""
    end = time.monotonic() + limit
    while not (holds := bool(condition())) and time.monotonic() < end:
        code = child.process.poll()
        if code is not None:
            last = child.last_lines(1).strip() or "it said nothing"
            raise Mistake(f"{file}: ended, {describe_exit(code)}: {last}")
        time.sleep(PAUSE)
    return holds

"""All processes of a round, recognised by its mark, whatever started them."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import time
from collections.abc import Callable
from pathlib import Path

MARK = "CHAOS_ROUND"  # environment variable
POLL = 0.05  # s


def members(mark: str) -> dict[int, str]:
    """Command lines of running processes, by process id."""
    needle, found = f"{MARK}={mark}".encode(), {}
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):  # gone by now, or another user's
            if needle in (folder / "environ").read_bytes().split(b"\0"):
                words = (folder / "cmdline").read_bytes().rstrip(b"\0").split(b"\0")
                found[int(folder.name)] = b" ".join(words).decode(errors="replace")
    return found


def matching(mark: str, pattern: str) -> list[int]:
    """Ids of those whose command line matches this regular expression."""
    return [pid for pid, line in members(mark).items() if re.search(pattern, line)]


def send(pids: list[int], number: signal.Signals) -> None:
    """Send a signal to those that still run."""
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)


def wait_until(condition: Callable[[], object], limit: float) -> bool:
    """Whether the condition became true within `limit` s, wall."""
    until = time.monotonic() + limit
    while not condition():
        if time.monotonic() > until:
            return False
        time.sleep(POLL)
    return True


def end_left_over(mark: str, grace: float) -> list[str]:
    """Kill processes that still run after `grace` s, wall; returns their command lines."""
    wait_until(lambda: not members(mark), grace)
    left = members(mark)
    lines = list(left.values())
    while left:
        send(list(left), signal.SIGKILL)
        time.sleep(POLL)
        left = members(mark)
    return lines

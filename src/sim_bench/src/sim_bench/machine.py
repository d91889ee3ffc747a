"""What the figures were measured on, and how much of it others used meanwhile."""

from __future__ import annotations

import os
import platform
import time
from pathlib import Path

import psutil

from run_session import processes
from run_session.session import versions


def describe() -> dict:
    """Processor, cores, memory and versions, for bench.json."""
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_gb": round(psutil.virtual_memory().total / 1e9, 1),
        "kernel": platform.release(),
        "versions": versions(Path(__file__).parent, ()),
    }


class Others:
    """Processor time of everything that is neither this process nor started by it."""

    def __init__(self) -> None:
        self._began, self._busy, self._ours = time.monotonic(), _busy(), _ours()

    def percent(self) -> float:
        """Of one core, since this was made."""
        elapsed = time.monotonic() - self._began
        theirs = (_busy() - self._busy) - (_ours() - self._ours)
        return max(0.0, 100.0 * theirs / elapsed)


def _busy() -> float:
    """s that all cores together have worked since the machine's start."""
    times = psutil.cpu_times()
    return times.user + times.nice + times.system + times.irq + times.softirq


def _ours() -> float:
    """s that this process, its children that have ended and those that live have worked."""
    times = os.times()
    ended = times.user + times.system + times.children_user + times.children_system
    return ended + sum(process.cpu for process in processes.processes())


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        key, _, value = line.partition(":")
        if key.strip() == "model name":
            return value.strip()
    return platform.machine()

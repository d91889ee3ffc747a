"""Processor time and memory of the processes below this one, by the names that ROS gave them."""

from __future__ import annotations

import contextlib
import re
import time
from collections import defaultdict
from dataclasses import dataclass

import psutil

NODE_NAME = re.compile(r"\b__name:=(\S+)")
PROGRAM = re.compile(r"(rosmaster|roscore|roslaunch|bench\.probes\.\w+)")


@dataclass(frozen=True)
class Process:
    """One process as it is now."""

    pid: int
    name: str  # of the ROS node, or of the program; a nameless child has its parent's
    cpu: float  # s of processor time since its start
    memory: int  # bytes in RAM


def processes(root: int | None = None) -> list[Process]:
    """All processes below `root` (this one), without it."""
    found: list[Process] = []
    names: dict[int, str] = {}
    for each in psutil.Process(root).children(recursive=True):  # parents come first
        with contextlib.suppress(psutil.NoSuchProcess), each.oneshot():
            parent = names.get(each.ppid(), "other")
            name = names[each.pid] = process_name(" ".join(each.cmdline()), parent)
            used = each.cpu_times()
            found.append(Process(each.pid, name, used.user + used.system, each.memory_info().rss))
    return found


def process_name(command_line: str, parent: str) -> str:
    """What to call a process: the node's name, else the program's, else as its parent."""
    node = NODE_NAME.search(command_line)
    if node:
        return node[1].strip("/")
    programs = PROGRAM.findall(command_line)
    return programs[-1].rpartition(".")[2] if programs else parent


class CpuMeter:
    """Percent of one core that each process used since the last look."""

    def __init__(self) -> None:
        self._looked, self._used = time.monotonic(), self._now()

    def look(self) -> dict[str, float]:
        """By name; what has ended since the last look is not in it."""
        now, used = time.monotonic(), self._now()
        spent: dict[str, float] = defaultdict(float)
        for pid, (name, seconds) in used.items():
            spent[name] += seconds - self._used.get(pid, (name, 0.0))[1]
        elapsed = now - self._looked
        self._looked, self._used = now, used
        return {name: 100 * seconds / elapsed for name, seconds in spent.items()}

    @staticmethod
    def _now() -> dict[int, tuple[str, float]]:
        return {process.pid: (process.name, process.cpu) for process in processes()}


def memory(name: str) -> int:
    """Bytes in RAM of all processes of that name."""
    return sum(process.memory for process in processes() if process.name == name)

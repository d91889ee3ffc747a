"""CPU time and memory of this process's descendants, by their ROS node names."""

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
    name: str  # of the ROS node, or of the program; else the parent's
    cpu: float  # s of CPU time since its start
    memory: int  # bytes in RAM


def processes(root: int | None = None) -> list[Process]:
    """All descendants of process `root` (default: this one)."""
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
    """A process's name: the node's, else the program's, else the parent's."""
    node = NODE_NAME.search(command_line)
    if node:
        return node[1].strip("/")
    programs = PROGRAM.findall(command_line)
    return programs[-1].rpartition(".")[2] if programs else parent


class CpuMeter:
    """Percent of one core that each process used since the last call."""

    def __init__(self) -> None:
        self._looked, self._used = time.monotonic(), self._now()

    def look(self) -> dict[str, float]:
        """Percent of a core by name; processes that ended since the last call are left out."""
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

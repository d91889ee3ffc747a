"""Processor time and memory of the processes below this one, by the names that ROS gave them."""

from __future__ import annotations

import os
import re
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

TICK = 1.0 / os.sysconf("SC_CLK_TCK")  # s, what /proc counts in
PAGE = os.sysconf("SC_PAGE_SIZE")  # bytes
NODE_NAME = re.compile(r"\b__name:=(\S+)")
PROGRAM = re.compile(r"(rosmaster|roscore|roslaunch|bench\.probes\.\w+)")


@dataclass(frozen=True)
class Process:
    """One process as /proc shows it now."""

    pid: int
    name: str  # of the ROS node, or of the program; a nameless child has its parent's
    cpu: float  # s of processor time since its start
    memory: int  # bytes in RAM


def processes(root: int | None = None) -> list[Process]:
    """All processes below `root` (this one), without it."""
    table = _table()
    below: dict[int, list[int]] = defaultdict(list)
    for pid, (parent, *_) in table.items():
        below[parent].append(pid)
    found, waiting = [], [(root or os.getpid(), "other")]
    while waiting:
        parent, parent_name = waiting.pop()
        for pid in below[parent]:
            name = process_name(_command_line(pid), parent_name)
            found.append(Process(pid, name, *table[pid][1:]))
            waiting.append((pid, name))
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


def _table() -> dict[int, tuple[int, float, int]]:
    """Parent, s of processor time and bytes of memory of every process of the machine."""
    table = {}
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            stat = Path("/proc", entry, "stat").read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue  # gone by now
        columns = stat.rpartition(")")[2].split()  # from the third column of proc(5) on
        ticks = int(columns[11]) + int(columns[12])
        table[int(entry)] = (int(columns[1]), ticks * TICK, int(columns[21]) * PAGE)
    return table


def _command_line(pid: int) -> str:
    try:
        raw = Path("/proc", str(pid), "cmdline").read_bytes()
    except OSError:
        return ""
    return raw.replace(b"\0", b" ").decode(errors="replace")

"""Starts a run's processes, ends them with their descendants, measures their CPU time."""

from __future__ import annotations

import contextlib
import ctypes
import os
import re
import signal
import subprocess
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import psutil

from run_session.files import Tail

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36  # <linux/prctl.h>
INTERRUPT_TIME, TERMINATE_TIME, KILL_TIME = 1.2, 0.4, 0.6  # s; all within the 3 s of a Ctrl-C
# Colours and all else that begins with ESC [; window titles; other characters with ESC
_TERMINAL_CODES = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b\n]*\x07?|\x1b.?")
_libc = ctypes.CDLL(None, use_errno=True)


@dataclass
class Child:
    """One started program whose output goes to a file, which is read as it grows."""

    name: str
    process: subprocess.Popen
    log: Path

    def __post_init__(self) -> None:
        self._tail = Tail(self.log)

    def new_lines(self) -> list[str]:
        """Whole lines written since the last call."""
        return [strip_terminal_codes(line) for line in self._tail.lines()]

    def last_lines(self, count: int = 12) -> str:
        """The end of its output, for an error message."""
        text = self.log.read_text(encoding="utf-8", errors="replace")
        lines = strip_terminal_codes(text).splitlines()
        return "\n".join([line for line in lines if line.strip()][-count:])


class Family:
    """All processes of one run; used as a context manager, it leaves none behind."""

    def __init__(self) -> None:
        self._children: list[Child] = []
        self.spared: int | None = None  # id of the process that is not asked to end with the others
        # Orphans become our children, not init's: a killed roslaunch cannot leave its nodes behind.
        _libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)

    def start(
        self, name: str, command: list[str], environment: Mapping[str, str], log: Path
    ) -> Child:
        """Start a program as `start_program` does."""
        self._children.append(Child(name, start_program(command, environment, log), log))
        return self._children[-1]

    def __enter__(self) -> Family:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def end(self, child: Child, limit: float = 2 * INTERRUPT_TIME) -> None:
        """End one child that was started here and all its descendants, by force if that takes
        longer than `limit` (s, wall)."""
        self._children.remove(child)
        try:
            below = psutil.Process(child.process.pid).children(recursive=True)
        except psutil.NoSuchProcess:
            below = []
        until = time.monotonic() + limit
        child.process.send_signal(signal.SIGINT)
        try:
            child.process.wait(limit)
        except subprocess.TimeoutExpired:
            child.process.kill()
            child.process.wait()
        _, left = psutil.wait_procs(below, max(0.0, until - time.monotonic()))
        for each in left:
            with contextlib.suppress(psutil.NoSuchProcess):
                each.kill()
        psutil.wait_procs(left)

    def stop(self) -> None:
        """End all: by SIGINT, SIGTERM, then SIGKILL; returns when they are gone."""
        steps = (
            (signal.SIGINT, INTERRUPT_TIME),
            (signal.SIGTERM, TERMINATE_TIME),
            (signal.SIGKILL, KILL_TIME),
        )
        for number, limit in steps:
            self._send(number)
            until = time.monotonic() + limit
            while self._living():
                if time.monotonic() > until:
                    break
                time.sleep(0.1)  # each look reads all of /proc
            else:
                return

    def _send(self, number: int) -> None:
        for pid in self._living():
            try:
                os.kill(pid, number)
            except ProcessLookupError:
                continue

    def _living(self) -> list[int]:
        """Process ids of all descendants but the spared one; reaps those that ended."""
        own = {child.process.pid: child.process for child in self._children}
        living = []
        for each in psutil.Process().children(recursive=True):
            if each.pid == self.spared:
                continue
            try:
                ended = each.status() == psutil.STATUS_ZOMBIE
            except psutil.NoSuchProcess:
                continue
            if not ended:
                living.append(each.pid)
            elif each.pid in own:
                own[each.pid].poll()
            else:
                _collect(each.pid)
        return living


def start_program(command: list[str], environment: Mapping[str, str], log: Path
                  ) -> subprocess.Popen:
    """Start a program in a session of its own; the kernel signals it to end if we die first."""
    with log.open("wb") as output:
        return subprocess.Popen(
            command, env=environment, stdin=subprocess.DEVNULL, stdout=output,
            stderr=subprocess.STDOUT, start_new_session=True,
            preexec_fn=end_with_parent(os.getpid()))


def strip_terminal_codes(text: str) -> str:
    """The text without colours and window titles."""
    return _TERMINAL_CODES.sub("", text)


def read_log(path: Path) -> list[str]:
    """A log's lines."""
    return strip_terminal_codes(path.read_text(encoding="utf-8", errors="replace")).splitlines()


def end_with_parent(parent: int) -> Callable[[], None]:
    """A preexec function: has the kernel send the child SIGTERM when this parent dies."""

    def prepare() -> None:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)  # Python's handler would swallow it here
        _libc.prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
        if os.getppid() != parent:  # it has died already: no signal will come
            os._exit(0)

    return prepare


def _collect(pid: int) -> None:
    try:
        os.waitpid(pid, os.WNOHANG)
    except ChildProcessError:
        return  # not ours yet: its own parent has still to be reaped


NODE_NAME = re.compile(r"\b__name:=(\S+)")
PROGRAM = re.compile(r"(rosmaster|roscore|roslaunch)")


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
    return programs[-1] if programs else parent


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

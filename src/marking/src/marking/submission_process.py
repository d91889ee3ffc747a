"""Runs one submission's program in its sandbox, and kills it if it exceeds its limits."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from pathlib import Path

import psutil

from marking.bubblewrap import HOME, SUBMISSION, Kind, sandbox
from marking.rules import Limits
from marking.submissions import one_line

KEPT_OUTPUT = 64 * 1024  # bytes of the student's output that are kept
GUARD_PERIOD, END_TIME = 0.2, 2.0  # s, wall
LONGEST_REASON = 200  # characters
COLOUR = re.compile(r"\x1b\[[\d;]*m")  # of rospy's log


class SubmissionProcess:
    """One submission's running program; its output goes to a file, up to KEPT_OUTPUT."""

    def __init__(self, kind: Kind, folder: Path, program: Path, limits: Limits,
                 environment: Mapping[str, str], output: Path):
        """Start it. `folder` holds the submission, `program` is relative to it."""
        self._limits = limits
        where = self._where = str(folder if kind is Kind.NONE else SUBMISSION)
        path = environment.get("PYTHONPATH", "")
        own = {"PYTHONPATH": f"{where}/src:{path}" if (folder / "src").is_dir() else path,
               "PYTHONUNBUFFERED": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        if kind is not Kind.NONE:
            own |= {"HOME": HOME, "ROS_LOG_DIR": HOME, "ROS_HOME": HOME}
        self._process = subprocess.Popen(
            [*sandbox(kind, limits, folder), sys.executable, f"{where}/{program}"],
            cwd=folder if kind is Kind.NONE else "/", env={**environment, **own},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            start_new_session=True)
        self._output, self._printed, self._excess = output, 0, ""
        self._threads = [threading.Thread(target=each, daemon=True)
                         for each in (self._read, self._guard)]
        for thread in self._threads:
            thread.start()

    def fault(self) -> str:
        """Why it has ended, in one line; "" while it runs."""
        if self._process.poll() is None:
            return ""
        for thread in self._threads:
            thread.join(END_TIME)
        ended = f"the program ended ({_describe(self._process.returncode)})"
        hint = "" if self._process.returncode else "; is rospy.spin() missing?"
        return self._excess or ended + hint

    def exception(self) -> str:
        """The exception that ended it, else the first that it printed, and where in its own files;
        "" if none or if it was killed: what it had printed by then may differ from run to run."""
        found = [] if self._excess else exceptions(
            self._output.read_text(encoding="utf-8", errors="replace"), self._where)
        return found[-1 if self._process.poll() == 1 else 0][:LONGEST_REASON] if found else ""

    def end(self) -> None:
        """Kill the program and all its descendants."""
        self._kill()
        self._process.wait()
        for thread in self._threads:
            thread.join(END_TIME)

    def _kill(self) -> None:
        for pid in (self._process.pid, *self._below()):
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)

    def _below(self) -> list[int]:
        """Process ids of all its descendants."""
        try:
            children = psutil.Process(self._process.pid).children(recursive=True)
        except psutil.NoSuchProcess:
            return []
        return [each.pid for each in children]

    def _guard(self) -> None:
        """Kill it if its processes together exceed limits that the kernel sets only for each."""
        while self._process.poll() is None and not self._excess:
            time.sleep(GUARD_PERIOD)
            self._excess = self._exceeded()
        if self._excess:
            self._kill()

    def _exceeded(self) -> str:
        """The limit that it exceeds, in one line; "" if none."""
        limits, running = self._limits, self._below()
        if len(running) > limits.processes:
            return f"it started more than {limits.processes:g} processes"
        if self._printed > limits.output_mb * 1e6:
            return f"it printed more than {limits.output_mb:g} MB"
        if sum(map(_resident_bytes, running)) > limits.memory_mb * 1e6:
            return f"it used more than {limits.memory_mb:g} MB of memory"
        return ""

    def _read(self) -> None:
        with self._output.open("wb") as file:
            while block := self._process.stdout.read1(65536):
                file.write(block[:max(0, KEPT_OUTPUT - self._printed)])
                self._printed += len(block)


def exceptions(printed: str, folder: str) -> list[str]:
    """The exceptions in what a program printed that went through files of its folder, a line each.
    """
    frame = re.compile(rf' *File "{re.escape(folder)}/(.+)", line (\d+)')
    found, place = [], None
    for line in COLOUR.sub("", printed).splitlines():
        if at := frame.match(line):
            place = at
        elif place and line.strip() and not line.startswith(" "):
            found.append(f"exception in {place[1]}, line {place[2]}: {one_line(line)}")
            place = None
    return found


def _resident_bytes(pid: int) -> int:
    """A process's resident memory, as its threads have it; the first of them may have ended."""
    with contextlib.suppress(OSError):  # it has just ended
        return max(map(_thread_bytes, Path(f"/proc/{pid}/task").iterdir()), default=0)
    return 0


def _thread_bytes(files: Path) -> int:
    with contextlib.suppress(OSError, IndexError):
        return os.sysconf("SC_PAGE_SIZE") * int((files / "statm").read_text().split()[1])
    return 0


def _describe(code: int) -> str:
    number = -code if code < 0 else code - 128  # bubblewrap adds 128 to a signal
    try:
        return f"killed by {signal.Signals(number).name}" if number > 0 else f"exit code {code}"
    except ValueError:
        return f"exit code {code}"

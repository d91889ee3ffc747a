"""One run: its folder for results, progress line, versions, and processes that end with it."""

from __future__ import annotations

import contextlib
import importlib.metadata
import json
import os
import platform
import shutil
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TextIO, TypeVar

from terminal_language import translated
from terminal_language.cells import cut

from run_session.failure import RunError
from run_session.files import check_space
from run_session.launch import Launched
from run_session.processes import Family

PLAIN_PERIOD = 10.0  # s, simulated
TERMINAL_PERIOD = 0.2  # s, wall
RATE_WINDOW = 5.0  # s, wall, over which the real-time factor is taken

T = TypeVar("T")


class StatusLine:
    """Knows where to write and when a line is due; the text comes from the caller.

    If nobody reads any more, as of `... | head`, that is as Ctrl-C: KeyboardInterrupt.
    """

    def __init__(self, stream: TextIO | None = None):
        self._stream = stream or sys.stdout
        self._in_place = self._stream.isatty()
        self._shown_at, self._next_plain = 0.0, 0.0
        self._times: deque[tuple[float, float]] = deque()
        self._open, self._part = False, ""

    @property
    def factor(self) -> float:
        """Real-time factor: simulated over wall time, of the last RATE_WINDOW."""
        (wall, simulated), (now, latest) = self._times[0], self._times[-1]
        return (latest - simulated) / (now - wall) if now > wall else 0.0

    def say(self, text: str) -> None:
        """Print a line that is not overwritten."""
        self.end()
        self._print(text)

    def status(self, text: str) -> None:
        """Show what is being waited for, on a terminal only."""
        if self._in_place:
            self._rewrite(text)

    def update(self, simulated: float, make_line: Callable[[], str], part: str = "") -> None:
        """Take another simulated time (s), which begins again with each part of the run.

        `make_line` is called if a line is due.
        """
        if part != self._part:
            self.end()
            self._times.clear()
            self._next_plain, self._part = 0.0, part
        now = time.monotonic()
        self._times.append((now, simulated))
        while now - self._times[0][0] > RATE_WINDOW:
            self._times.popleft()
        if self._in_place and now - self._shown_at >= TERMINAL_PERIOD:
            self._shown_at = now
            self._rewrite(make_line())
        elif not self._in_place and simulated >= self._next_plain:
            self._next_plain = (simulated // PLAIN_PERIOD + 1) * PLAIN_PERIOD
            self.say(make_line())

    def end(self) -> None:
        """Leave the line as it is and go to the next."""
        if self._open:
            self._print()
        self._open = False

    def _rewrite(self, text: str) -> None:
        # A wrapped line cannot be rewritten.
        shown = cut(translated(text), shutil.get_terminal_size().columns - 1)
        self._print(f"\r{shown}\x1b[K", end="")
        self._open = True

    def _print(self, text: str = "", end: str = "\n") -> None:
        try:
            print(text, end=end, file=self._stream, flush=True)
        except BrokenPipeError:
            raise KeyboardInterrupt from None


PACKAGES = ("pybullet", "moderngl", "opencv-python-headless", "numpy")
RENDERER_SAYS = "Cameras are drawn by"  # the simulator's log line


def versions(root: Path, log: Iterable[str]) -> dict:
    """Versions by name; the renderer is as the simulator logged it."""
    found = {"python": platform.python_version(), "machine": platform.platform()}
    for package in PACKAGES:
        try:
            found[package] = importlib.metadata.version(package)
        except importlib.metadata.PackageNotFoundError:
            found[package] = None
    drawn = (line.partition(RENDERER_SAYS)[2].strip() for line in log if RENDERER_SAYS in line)
    found["renderer"] = next(drawn, None)
    found["revision"] = _revision(root)
    return found


def _revision(root: Path) -> str | None:
    command = ["git", "-C", str(root), "describe", "--always", "--dirty"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=0.5, check=True)
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip()


LOG = "log"  # the logs' folder in that for results
DRIVEN = (0, 1)  # exit codes of a program whose drive took place


class Session:
    """A context manager; `out` is the folder for results."""

    def __init__(self, out: Path):
        self.out = out
        self.family = Family()
        self.progress = StatusLine()
        self._at_end = contextlib.ExitStack()
        self._shared: list = []

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self._at_end.close()
            self.family.stop()
        except BaseException:  # the first Ctrl-C may come here; later ones are ignored
            self.family.stop()
            raise
        finally:
            self.progress.end()

    def once(self, make: Callable[[], T]) -> T:
        """What `make` returned at the first call: that which all cases of this session use."""
        if not self._shared:
            self._shared.append(make())
        return self._shared[0]

    def at_end(self, act: Callable[[], object]) -> None:
        """Call `act` before the processes are ended."""
        self._at_end.callback(act)

    def launched(self, vehicle: str, driver: str = "", alone: bool = False,
                 environment: Mapping[str, str] | None = None, joined: bool = False,
                 master: str = "") -> Launched:
        """This run's own ROS master and launch files; logs go to OUT/log.

        `alone`: in a network namespace of its own; `environment`: further variables; `joined`: by
        other terminals; `master`: the URI of one that runs already.
        """
        return Launched(self.family, self.out / LOG, driver, vehicle, alone, environment or {},
                        joined, master)

    def drive(self, command: list[str], folder: Path, what: str, limit: float,
              environment: Mapping[str, str] | None = None) -> dict:
        """Run a program that drives to its end; returns the report.json that it wrote there.

        RunError if it does not end within `limit`, s, wall, or did not drive, OSError if that was
        because the disk is full. An interrupted drive leaves no process and no report, so that
        --resume repeats it.
        """
        report = folder / "report.json"
        folder.mkdir(parents=True, exist_ok=True)
        report.unlink(missing_ok=True)
        child = self.family.start("drive", command, environment or os.environ,
                                  folder / "drive.log")
        try:
            child.process.wait(limit)
        except BaseException as early:
            self.family.end(child)  # it still writes a report
            report.unlink(missing_ok=True)
            if isinstance(early, subprocess.TimeoutExpired):
                late = f"{what}: the drive did not end within {limit:.0f} s"
                raise RunError(late, child.last_lines()) from early
            raise
        code = child.process.returncode
        if code not in DRIVEN or not report.exists():
            report.unlink(missing_ok=True)
            check_space(folder)
            *details, why = child.last_lines().splitlines() or [f"exit code {code}"]
            raise RunError(f"{what}: {why}", "\n".join(details))
        return json.loads(report.read_text(encoding="utf-8"))

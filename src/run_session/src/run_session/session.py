"""One run's processes, below one folder: all of them end with it."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

from run_session.failure import RunError
from run_session.launch import Launched
from run_session.processes import Child, Family
from run_session.status_line import StatusLine

DRIVEN = (0, 1)  # exit codes of a program that drove


class Session:
    """A context; `out` is the folder for results."""

    def __init__(self, out: Path):
        self.out = out
        self.family = Family()
        self.progress = StatusLine()
        self._at_end = contextlib.ExitStack()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self._at_end.close()
            self.family.stop()
        except BaseException:  # the first Ctrl-C may come meanwhile; later ones disturb nothing
            self.family.stop()
            raise
        finally:
            self.progress.end()

    def at_end(self, act: Callable[[], object]) -> None:
        """Do this before the processes end."""
        self._at_end.callback(act)

    def launched(self, vehicle: str, driver: str = "", alone: bool = False) -> Launched:
        """A ROS master and launch files of this run's own; logs go to OUT/log.

        `alone`: in a network namespace of its own.
        """
        return Launched(self.family, self.out / "log", driver, vehicle, alone)

    def start_drive(self, command: list[str], folder: Path,
                    environment: Mapping[str, str] | None = None) -> DriveProcess:
        """Start a program that drives and writes its report.json into this folder."""
        return DriveProcess(self.family, command, folder, environment or os.environ)


class DriveProcess:
    """A drive in a process of its own: what it writes is all that is known of it."""

    def __init__(self, family: Family, command: list[str], folder: Path,
                 environment: Mapping[str, str]):
        self._family, self._report = family, folder / "report.json"
        folder.mkdir(parents=True, exist_ok=True)
        self._report.unlink(missing_ok=True)
        self._child: Child = family.start("drive", command, environment, folder / "drive.log")

    def report(self, limit: float, what: str) -> dict:
        """Its report.json; RunError if it does not end within `limit`, s, wall, or did not drive.

        Half a drive leaves no process, and no report: it must not be taken for one by --resume.
        """
        try:
            self._child.process.wait(limit)
        except BaseException as early:
            self._family.end(self._child)  # it reports what it has seen
            self._report.unlink(missing_ok=True)
            if isinstance(early, subprocess.TimeoutExpired):
                late = f"{what}: the drive did not end within {limit:.0f} s"
                raise RunError(late, self._child.last_lines()) from early
            raise
        code = self._child.process.returncode
        if code not in DRIVEN or not self._report.exists():
            self._report.unlink(missing_ok=True)
            *details, why = self._child.last_lines().splitlines() or [f"exit code {code}"]
            raise RunError(f"{what}: {why}", "\n".join(details))
        return json.loads(self._report.read_text(encoding="utf-8"))

"""One run's processes, with one folder for results: all of them end with it."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path

from run_session.failure import RunError
from run_session.files import check_space
from run_session.launch import Launched
from run_session.processes import Child, Family
from run_session.status_line import StatusLine

DRIVEN = (0, 1)  # exit codes of a program whose drive took place


class Session:
    """A context manager; `out` is the folder for results."""

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
        except BaseException:  # the first Ctrl-C may come here; later ones are ignored
            self.family.stop()
            raise
        finally:
            self.progress.end()

    def at_end(self, act: Callable[[], object]) -> None:
        """Call `act` before the processes are ended."""
        self._at_end.callback(act)

    def launched(self, vehicle: str, driver: str = "", alone: bool = False,
                 environment: Mapping[str, str] | None = None) -> Launched:
        """This run's own ROS master and launch files; logs go to OUT/log.

        `alone`: in a network namespace of its own; `environment`: further variables.
        """
        return Launched(self.family, self.out / "log", driver, vehicle, alone, environment or {})

    def start_drive(self, command: list[str], folder: Path,
                    environment: Mapping[str, str] | None = None) -> DriveProcess:
        """Start a program that makes a drive and writes its report.json into this folder."""
        return DriveProcess(self.family, command, folder, environment or os.environ)


class DriveProcess:
    """A drive in a process of its own, known only by what it writes."""

    def __init__(self, family: Family, command: list[str], folder: Path,
                 environment: Mapping[str, str]):
        self._family, self._report = family, folder / "report.json"
        folder.mkdir(parents=True, exist_ok=True)
        self._report.unlink(missing_ok=True)
        self._child: Child = family.start("drive", command, environment, folder / "drive.log")

    def report(self, limit: float, what: str) -> dict:
        """Its report.json; RunError if it does not end within `limit`, s, wall, or did not drive,
        OSError if that was because the disk is full.

        An interrupted drive leaves no process and no report, so that --resume repeats it.
        """
        try:
            self._child.process.wait(limit)
        except BaseException as early:
            self._family.end(self._child)  # it still writes a report
            self._report.unlink(missing_ok=True)
            if isinstance(early, subprocess.TimeoutExpired):
                late = f"{what}: the drive did not end within {limit:.0f} s"
                raise RunError(late, self._child.last_lines()) from early
            raise
        code = self._child.process.returncode
        if code not in DRIVEN or not self._report.exists():
            self._report.unlink(missing_ok=True)
            check_space(self._report.parent)
            *details, why = self._child.last_lines().splitlines() or [f"exit code {code}"]
            raise RunError(f"{what}: {why}", "\n".join(details))
        return json.loads(self._report.read_text(encoding="utf-8"))

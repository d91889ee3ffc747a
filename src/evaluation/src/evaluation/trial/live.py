"""A single drive that is watched and filmed: brought up, watched, ended and reported."""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar

from evaluation.session.failure import RunError
from evaluation.session.film import FilmFile
from evaluation.session.launch import Launched
from evaluation.session.session import Session
from evaluation.session.status_line import StatusLine
from evaluation.trial.program import NOT_PASSED, PASSED

Outcome = tuple[str, str]  # a word, and why


class LiveDrive(ABC):
    """One drive; its report is also written of a drive that ended early."""

    program: ClassVar[str]
    writes: ClassVar[Sequence[str]]  # files in `out`
    vehicle: ClassVar[str] = "car"
    driver = ""  # the script that drives, for messages

    def __init__(self, out: Path, progress: StatusLine):
        self.out, self.progress = out, progress
        self.film: FilmFile | None = None

    @abstractmethod
    def bring_up(self, launched: Launched) -> None:
        """Start everything and wait until it is there."""

    @abstractmethod
    def watch(self, launched: Launched) -> Outcome:
        """Returns when nothing more is to be seen."""

    @abstractmethod
    def end(self) -> None:
        """Count what is still to be counted, while all still runs; then look no more."""

    @property
    @abstractmethod
    def was_seen(self) -> bool:
        """Whether there is something to report."""

    @abstractmethod
    def report(self, outcome: Outcome, log_folder: Path) -> None:
        """Write and print what was found."""

    @abstractmethod
    def faults(self, outcome: Outcome) -> list[str]:
        """What was not good, one line each; "" is one that the report says already."""

    def owned_files(self) -> Sequence[str]:
        """Files of `out` that a run before may have left, and that are not to be kept."""
        return self.writes

    def name_files(self) -> None:
        """Say where the files are."""
        here = Path.cwd()
        made = [self.out / name for name in self.writes if (self.out / name).exists()]
        shown = [str(path.relative_to(here) if path.is_relative_to(here) else path)
                 for path in made]
        self.progress.say(f"files: {'  '.join(shown)}")


def run_live(drive: LiveDrive) -> int:
    """From beginning to end; returns the exit code, or raises what ended it early."""
    _make_room(drive)
    early = None
    with Session(drive.out) as session:
        launched = session.launched(drive.vehicle, drive.driver)
        try:
            drive.bring_up(launched)
            outcome = drive.watch(launched)
        except (KeyboardInterrupt, RunError) as ended:
            early, outcome = ended, ("ended early", str(ended) or "interrupted")
        if drive.film is not None:
            drive.film.stop()
        drive.end()
        # They end while the film is being finished.
        session.family.interrupt(spare=drive.film.process_id if drive.film else None)
        if drive.film is not None:
            drive.film.close()
    if drive.was_seen:
        drive.report(outcome, launched.log_folder)
    if early is not None:
        raise early
    faults = drive.faults(outcome)
    for fault in filter(None, faults):
        print(f"{drive.program}: {fault}", file=sys.stderr)
    return NOT_PASSED if faults else PASSED


def _make_room(drive: LiveDrive) -> None:
    """What is in the folder afterwards is of this run."""
    try:
        drive.out.mkdir(parents=True, exist_ok=True)
        for name in drive.owned_files():
            (drive.out / name).unlink(missing_ok=True)
    except PermissionError:
        raise
    except OSError as error:
        raise RunError(f"--out {drive.out}: {error.strerror}") from error

"""One round: a drive, a fault at a random moment, and the checks afterwards."""

from __future__ import annotations

import math
import shutil
import subprocess
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random

from checks import half_files, wrong_logs, wrong_words
from clock import clock_environment
from course import CourseUnderTest
from drive import DURATION, JudgedDrive
from faults import CLOCK, Fault, empty_disk, faults_of
from members import wait_until
from states import STOP_TIME, drives_on

START_LIMIT, END_LIMIT = 600.0, 240.0  # s, wall, on a busy machine
GRACE = 60.0  # s, wall, on a busy machine
LONGEST_STOP = 3.0  # s, wall
DISK = "size=24m"
RESULTS = "results"  # in the folder of a round that failed
WATCHED = STOP_TIME + 0.3  # s, simulated, for which a car without a driver is observed
WATCH_LIMIT = 100.0  # s, wall, for that: in lockstep the world waits a second for each image


@dataclass(frozen=True)
class Round:
    """The fault and timing that a seed determines."""

    course: CourseUnderTest
    seed: int
    fault: Fault
    fast: bool
    film: bool
    starting: bool  # the fault comes before the car drives
    delay: float  # s, wall
    roscore: bool  # by hand: roscore runs in a terminal of its own, not roslaunch's

    @property
    def title(self) -> str:
        """For the table."""
        return f"{self.fault.name}{' while starting' if self.starting else ''}"


def drawn(course: CourseUnderTest, seed: int, only: str = "") -> Round:
    """The round of this seed, among faults whose name begins with `only`."""
    rng = Random(f"{course.name}/{seed}")
    choice = [each for each in faults_of(course.drivers) if each.name.startswith(only)]
    fault = rng.choice(choice)
    encoder = fault.victim == "encoder"
    return Round(course, seed, fault, rng.random() < 0.4, encoder or rng.random() < 0.5,
                 not encoder and rng.random() < 0.3, rng.uniform(0.0, 2.5),
                 fault.roscore or rng.random() < 0.5)


class Play:
    """Plays a round in a folder; `results` is shared with earlier rounds."""

    def __init__(self, played: Round, folder: Path, results: Path):
        self._round, self._folder, self._results = played, folder, results
        self._rng = Random(f"{played.course.name}/{played.seed}/act")

    @property
    def _without_driver(self) -> bool:
        """Whether the car must stand still meanwhile."""
        played = self._round
        return played.fault.victim in played.course.drivers and not played.starting

    def faults(self) -> list[str]:
        """Play the round; returns the errors found, one line each."""
        played = self._round
        self._folder.mkdir(parents=True)
        self._results.mkdir(parents=True, exist_ok=True)
        if played.fault.on_tmpfs:
            _mount(self._results)
        try:
            return list(dict.fromkeys(self._play()))
        finally:
            if played.fault.on_tmpfs:
                shutil.copytree(self._results, self._folder / RESULTS)
                subprocess.run(["umount", "--lazy", str(self._results)], check=True)

    def _play(self) -> Iterator[str]:
        played = self._round
        clock = clock_environment(self._folder) if played.fault.name == CLOCK else {}
        drive = JudgedDrive(played.course, self._folder, self._results, played.fast, played.film,
                            clock)
        try:
            if not self._wait_for_moment(drive):
                yield f"never came so far: {_last_line(drive)}"
                return
            if not self._is_victim_there(drive):
                yield f"there is no {played.fault.victim} that it could happen to"
                return
            since, until = self._act(drive)
            code = drive.wait(END_LIMIT)
            if code is None:
                yield f"the judge has not ended within {END_LIMIT:g} s"
        finally:
            left = drive.close(GRACE)
            empty_disk(self._results)
        yield from (f"left behind: {line[:100]}" for line in left)
        if code is not None and code not in self._codes(since):
            yield f"the judge ended with {code}: {_last_line(drive)}"
        yield from wrong_words(drive.log.read_text(encoding="utf-8", errors="replace"), code)
        yield from wrong_logs(self._results / "log")
        yield from half_files(self._results)
        if self._without_driver and (late := drives_on(drive.places(), since, until)):
            yield late

    def _wait_for_moment(self, drive: JudgedDrive) -> bool:
        played = self._round
        if played.starting:
            there = drive.wait_for(
                lambda: not played.fault.victim or drive.pids(played.fault.victim), START_LIMIT)
        else:
            there = drive.wait_for(drive.moves, START_LIMIT)
        if there:
            time.sleep(played.delay)  # a random moment, not a wait
        return there

    def _is_victim_there(self, drive: JudgedDrive) -> bool:
        """Whether the victim runs; near the drive's end it need not."""
        victim = self._round.fault.victim
        return bool(not victim or drive.pids(victim) or drive.judge.poll() is not None
                    or _is_late(drive.now()))

    def _act(self, drive: JudgedDrive) -> tuple[float, float]:
        """Inject the fault; returns its begin and end, s, simulated."""
        fault = self._round.fault
        fault.begin(drive, self._rng)
        since = drive.now()
        if fault.end is None:
            return since, math.inf
        try:
            time.sleep(self._rng.uniform(0.3, LONGEST_STOP))  # part of the test, not a wait
            if self._without_driver:
                wait_until(lambda: drive.now() > since + WATCHED, WATCH_LIMIT)
            return since, drive.now()
        finally:
            fault.end(drive)

    def _codes(self, since: float) -> tuple[int, ...]:
        """The allowed exit codes; near its end the drive may have ended before the fault."""
        codes = self._round.fault.codes
        return (*codes, 0, 1) if _is_late(since) else codes


def _is_late(now: float) -> bool:
    return now > DURATION / 2


def _last_line(drive: JudgedDrive) -> str:
    lines = drive.log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return lines[-1][:300] if lines else "it said nothing"


def _mount(folder: Path) -> None:
    subprocess.run(["mount", "-t", "tmpfs", "-o", DISK, "tmpfs", str(folder)], check=True)

"""A car's drive, followed by its true poses from the first one until the drive is over."""

from __future__ import annotations

import argparse
import time
from abc import abstractmethod
from collections.abc import Sequence

from evaluation.lap import LapScorer, Sample, fingerprint
from evaluation.trial.live import LiveDrive, Outcome
from run_session.course import Course
from run_session.fingerprints import Fingerprints
from run_session.frames import frame_figures
from run_session.launch import Launched
from run_session.observer import Observer

LOOK_PERIOD = 0.05  # s, wall, between two checks of processes and samples


class CarDrive(LiveDrive):
    """Options are those of LiveDrive and `fast`; `drive` scores and keeps the samples."""

    def __init__(self, options: argparse.Namespace, course: Course, drive: LapScorer):
        """`drive` has `samples`, takes one more by `add`, and says when it is `over`."""
        super().__init__(options)
        self.course, self.drive = course, drive
        self.fingerprints: Fingerprints | None = None
        self._first_at = self._last_at = time.monotonic()  # s, wall: arrival of these samples
        self._observer: Observer | None = None
        self._frames = 0, 0  # images and commands
        self.sensor_sums: dict[str, str | None] = {}

    @abstractmethod
    def launch_words(self) -> Sequence[str]:
        """Arguments of roslaunch: package, launch file, its arguments."""

    @abstractmethod
    def outcome(self) -> Outcome:
        """The outcome of a drive that is over."""

    @abstractmethod
    def line(self) -> str:
        """The progress line."""

    def bring_up(self, launched: Launched) -> None:
        """Start everything and wait until the car is there."""
        words = self.launch_words()
        listened = self.course.sensors if self.fingerprints else ()
        self._observer = Observer(launched.master_uri, self.course.robot_name(words[2:]),
                                  self.course, lockstep=self.options.fast, listened=listened)
        launched.start("roslaunch", ["roslaunch", *words])
        if self.fingerprints:
            self.fingerprints.start()  # before time may begin
        self._observer.start()
        if self.film is not None:
            self.film.start()
        launched.wait_for(lambda: self._observer.missing, self._take_samples,
                          self.options.startup_timeout, self.progress.status, pause=0.0)

    def watch(self, launched: Launched) -> Outcome:
        """Follow the car until the drive is over."""
        while not self.drive.over:
            self._take_samples()
            now = self.drive.samples[-1].time
            self.progress.update(now, self.line)
            self.check_time(launched, now)
        return self.outcome()

    def _take_samples(self) -> int:
        """Score the samples of the last LOOK_PERIOD; those after the end do not count."""
        arrivals = self._observer.samples(LOOK_PERIOD)
        samples: list[Sample] = self.drive.samples
        for arrived, seen in arrivals:
            sample = Sample(*seen)
            if samples and self.drive.over:
                break
            if not samples:
                self._first_at = self._last_at = arrived
            elif sample.time > samples[-1].time:
                self._last_at = arrived
            self.drive.add(sample)
        return len(arrivals)

    def end(self) -> None:
        """Count the images up to the last sample, and stop observing."""
        if self._observer is None:
            return
        if self.was_seen:
            self._frames = self._observer.count(self.drive.samples[-1].time)
            if self.fingerprints:
                self.sensor_sums = self.fingerprints.sums(self.drive.samples[-1].time)
        self._observer.stop()

    @property
    def was_seen(self) -> bool:
        return bool(self.drive.samples)

    @property
    def simulated(self) -> float:
        """Simulated time from the first sample to the last, s."""
        samples = self.drive.samples
        return samples[-1].time - samples[0].time if samples else 0.0

    def counted(self, log: list[str], digits: int) -> dict:
        """Frames, times and the drive's checksum, for the report."""
        simulated, wall = self.simulated, self._last_at - self._first_at
        return {**frame_figures(*self._frames, log if self.options.fast else None),
                "drive_sha256": fingerprint(self.drive),
                "simulated_s": round(simulated, digits), "wall_s": round(wall, digits),
                "real_time_factor": round(simulated / wall, digits) if wall > 0 else None}

    def fast_arguments(self) -> list[str]:
        """Launch arguments to run as fast as possible, in lockstep."""
        if not self.options.fast:
            return []
        # At five times real time the usual 100 Hz would wake every node 500 times a second.
        return ["paused:=true", "real_time_factor:=0",
                f"lockstep:={','.join(self.course.lockstep)}", "pub_clock_frequency:=30"]

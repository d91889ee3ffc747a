"""The run from beginning to end: bring up, watch, score, end everything, report."""

from __future__ import annotations

import time
from pathlib import Path

import cv2

from evaluation.course_run.options import Options, parse_options
from evaluation.course_run.progress import Progress
from evaluation.course_run.report import conditions, followers_table, summarize, write_report
from evaluation.course_run.video import Film
from evaluation.lap import LapScorer, Verdict
from evaluation.picture import path_picture
from evaluation.session.failure import RunError
from evaluation.session.film import FAST_FILM_PERIOD, FILM_PERIOD
from evaluation.session.fingerprints import Fingerprints
from evaluation.session.frames import frame_figures
from evaluation.session.launch import Launched
from evaluation.session.observer import Observer
from evaluation.session.processes import read_log
from evaluation.session.versions import versions
from evaluation.track import TrackError, TrackFile, build_track, load_track_file
from evaluation.trial.live import LiveDrive, Outcome, run_live
from evaluation.trial.program import run_program

LOOK_PERIOD = 0.05  # s, wall, between two looks at processes and samples


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("course_run", lambda: _run(parse_options(arguments)))


class CourseRun(LiveDrive):
    """One run: what is watched and what was found."""

    program = "course_run"
    writes = ("path.png", "run.mp4", "report.json")

    def __init__(self, options: Options, track_file: TrackFile):
        super().__init__(options.out, Progress())
        self.options, self.track_file, self.driver = options, track_file, options.follower
        self.drive = LapScorer(
            build_track(track_file), options.laps, off_course=options.course.off_course)
        period = FAST_FILM_PERIOD if options.fast else FILM_PERIOD
        self.film = Film(options.out / "run.mp4", options.course, track_file, self.drive, period)
        self._first_at = self._last_at = time.monotonic()  # s, wall: when these samples came
        self._observer: Observer | None = None
        self._counted = 0, 0  # images and commands
        self._fingerprints = Fingerprints(options.course.sensors)
        self._sensor_sums: dict[str, str | None] = {}

    def bring_up(self, launched: Launched) -> None:
        """Start everything and wait until the car stands on the course."""
        options = self.options
        self.progress.status("starting roscore")
        launched.start_roscore()
        self._observer = Observer(
            launched.master_uri, options.robot, options.course, lockstep=options.fast,
            listened=options.course.sensors if options.fingerprint else ())
        arguments = ("gui:=false", f"follower:={options.follower}", *options.launch_args)
        launched.start("roslaunch", ["roslaunch", *options.launch, *arguments])
        self.progress.say(f"watch it: export ROS_MASTER_URI={launched.master_uri}")
        if options.fingerprint:
            self._fingerprints.start()  # before time may begin
        self._observer.start()
        launched.wait_for(lambda: self._observer.missing, self._take_samples, self.progress.status,
                          options.startup_timeout)
        if options.video:
            self.film.start()

    def watch(self, launched: Launched) -> Outcome:
        """Follow the car until its verdict or the duration's end; returns outcome and reason."""
        while self.drive.verdict is Verdict.DRIVING and not self._time_is_up:
            self._take_samples()
            self.progress.show(self.drive)
            now = self.drive.samples[-1].time
            launched.check(now)
            self._check_time_moves(now)
        if self.drive.verdict is Verdict.DRIVING:
            share = f"lap {len(self.drive.laps) + 1} was {self.drive.driven_share:.0%} driven"
            return "time is up", f"{self.options.duration:g} simulated s are over: {share}"
        return self.drive.verdict.value, self.drive.why

    def _take_samples(self) -> int:
        """Score what came in the last LOOK_PERIOD; what came after the end does not count."""
        arrivals = self._observer.samples(LOOK_PERIOD)
        for arrived, sample in arrivals:
            if self._time_is_up or self.drive.verdict is not Verdict.DRIVING:
                break
            if not self.drive.samples:
                self._first_at = self._last_at = arrived
            elif sample.time > self.drive.samples[-1].time:
                self._last_at = arrived
            self.drive.add(sample)
        return len(arrivals)

    @property
    def _time_is_up(self) -> bool:
        samples = self.drive.samples
        return bool(samples) and samples[-1].time - samples[0].time > self.options.duration

    def _check_time_moves(self, now: float) -> None:
        still = time.monotonic() - self._last_at
        if still > self.options.stuck_timeout:
            raise RunError(
                f"simulated time has stood still at {now:.1f} s for {still:.0f} s:"
                " the simulator is paused or hangs"
            )

    def end(self) -> None:
        """Count the images up to the last sample, and ask no more."""
        if self.drive.samples:
            end = self.drive.samples[-1].time
            self._counted = self._observer.count(end)
            self._sensor_sums = self._fingerprints.sums(end) if self.options.fingerprint else {}
        if self._observer is not None:
            self._observer.stop()

    @property
    def was_seen(self) -> bool:
        return bool(self.drive.samples)

    def faults(self, outcome: Outcome) -> list[str]:
        return [] if self.drive.verdict is Verdict.CLOSED else [outcome[1]]

    def report(self, outcome: Outcome, log_folder: Path) -> None:
        """Write path.png and report.json, print the table and where the files are."""
        out, follower = self.options.out, self.options.follower
        lines = read_log(log_folder / "roslaunch.log")
        frames = frame_figures(*self._counted, lines if self.options.fast else None)
        wall = self._last_at - self._first_at
        summary = summarize(self.drive, outcome, frames, wall) | conditions(self.options)
        made_with = versions(Path(__file__).parent, lines)
        summary |= {"film": self.film.codec or None, "versions": made_with}
        summary |= {"sensor_sha256": self._sensor_sums} if self._sensor_sums else {}
        picture = path_picture(self.track_file, self.drive, *_titles(follower, summary))
        cv2.imwrite(str(out / "path.png"), picture)
        runs = write_report(out, follower, summary)
        self.progress.say("\n" + followers_table(runs, follower))
        unanswered = summary["frames_dropped"]
        if self.options.fast and unanswered:
            self.progress.say(f"{unanswered} images without a command: no run will repeat this one")
        self.name_files()


def _run(options: Options) -> int:
    try:
        track_file = load_track_file(options.track)
        run = CourseRun(options, track_file)
    except TrackError as error:
        raise RunError(str(error)) from error
    return run_live(run)


def _titles(follower: str, summary: dict) -> tuple[str, str]:
    """Headline and figures for the picture of the path."""
    times = summary["lap_times_s"]
    laps = ", ".join(f"{time:.1f} s" for time in times[:3]) + (", ..." if len(times) > 3 else "")
    closed = f"{summary['laps_closed']} of {summary['laps_wanted']} laps closed"
    figures = (
        f"lap {laps or '-'}",
        f"{summary['distance_m']:.2f} m",
        f"beside the line RMS {summary['rms_lateral_m'] * 100:.1f} cm,"
        f" max {summary['max_lateral_m'] * 100:.1f} cm",
        f"real time x{summary['real_time_factor'] or 0:.2f}",
    )
    return f"{follower}: {closed}", "   |   ".join(figures)

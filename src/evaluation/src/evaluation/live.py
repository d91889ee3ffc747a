"""A single drive with supervision and video: started, observed, ended and reported."""

from __future__ import annotations

import argparse
import math
import re
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar, NamedTuple

from node_basics.ending import drop_unread_output, interruptible
from sim_viewer.replay_page import Curve
from terminal_language import translated

from bullet_sim.formats.run_log import Mark
from evaluation.command_line import (
    NOT_PASSED,
    PASSED,
    SAID,
    Parser,
    results_folder,
    run_program,
)
from evaluation.film import FilmFile
from evaluation.lap import LapScorer, Sample, fingerprint
from evaluation.run_log import RUN_LOG, add_marks, begin_run_log, marks_in
from evaluation.run_page import RECORDING, RUN_PAGE, begin_recording, write_run_page
from run_session.course_file import CourseFile
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.observer import Fingerprints, Observer, frame_figures
from run_session.processes import read_log
from run_session.session import LOG, Session, StatusLine, versions


class Outcome(NamedTuple):
    """How a drive ended: in a word, and why; faults, "" for one that the report already names."""

    word: str
    why: str = ""
    faults: Sequence[str] = ()


# s, wall; an emulated ARM processor takes minutes to start, and seconds for its first image
STARTUP_TIMEOUT, STUCK_TIMEOUT = 300.0, 60.0
EARLIER = "earlier"  # a folder in `out`
PATIENCE = 3.0  # s, wall, after which a drive that ends early says that it still ends


class LiveDrive(ABC):
    """One drive; a report is written even if it ended early."""

    program: ClassVar[str]
    does: ClassVar[str]  # for --help
    ends: ClassVar[str]  # what the exit codes mean
    usual_out: ClassVar[str]  # where results go, for --help
    writes: ClassVar[Sequence[str]]  # files in `out`
    stay: ClassVar[Sequence[str]] = ()  # those of the last run that stay until new ones are whole
    vehicle: ClassVar[str] = "car"
    logs: ClassVar[str] = "roslaunch.log"  # files in which the simulator names its renderer
    driver = ""  # the script that drives, for messages

    def __init__(self, options: argparse.Namespace):
        self.options, self.out = options, options.out
        self.progress = StatusLine()
        self.film: FilmFile | None = None
        self.summary = ""  # of the report, for people

    # --- options

    @classmethod
    @abstractmethod
    def add_options(cls, parser: Parser) -> None:
        """Add the options besides those that every drive has."""

    @classmethod
    def check(cls, options: argparse.Namespace) -> argparse.Namespace:
        """The completed options; RunError if they contradict one another."""
        return options

    @classmethod
    def parse(cls, arguments: Sequence[str]) -> argparse.Namespace:
        """Options from the command line, or RunError."""
        parser = Parser(prog=f"{cls.program}.py", description=cls.does,
                        epilog=f"Exit code: {cls.ends}, 2 could not run.")
        cls.add_options(parser)
        add = parser.add_argument
        add("--out", type=Path, metavar="DIR",
            help=f"where {', '.join(cls.writes)} and log/ go ({cls.usual_out})")
        add("--no-video", dest="video", action="store_false", help="write no run.mp4, no run.html")
        # A learner looks on from a second terminal, whose devel/setup.bash says 11311; nobody does
        # that to one of the many drives of a trial.
        add("--any-port", action="store_true",
            help="a ROS master on any free port, not 11311: no other terminal joins")
        add("--startup-timeout", type=float, default=STARTUP_TIMEOUT, metavar="S",
            help=f"wall seconds for what is started to be there ({STARTUP_TIMEOUT:g})")
        add("--stuck-timeout", type=float, default=STUCK_TIMEOUT, metavar="S",
            help=f"wall seconds that simulated time may stand still ({STUCK_TIMEOUT:g})")
        options = cls.check(parser.parse_args(arguments))
        options.out = (options.out or Path(cls.usual_out)).resolve()
        return options

    # --- the drive

    @abstractmethod
    def bring_up(self, launched: Launched) -> None:
        """Start everything and wait until it is up."""

    @abstractmethod
    def watch(self, launched: Launched) -> Outcome:
        """Observe the drive; returns its outcome when it is over."""

    @abstractmethod
    def end(self) -> None:
        """Do the final counts while everything still runs; then stop observing."""

    # --- results

    @abstractmethod
    def figures(self, outcome: Outcome, log: list[str]) -> dict | None:
        """The figures for report.json, if there are any; `log`: the simulator's output lines."""

    @abstractmethod
    def write(self, report: dict) -> list[str]:
        """Write pictures and report.json; returns the summary lines."""

    def marks(self) -> list[Mark]:
        """What is worth going back to, for RUN_LOG."""
        return []

    def curves(self) -> list[Curve]:
        """What RUN_PAGE shows besides the speed."""
        return []


def run_program_of(kind: type[LiveDrive], arguments: Sequence[str]) -> int:
    """Run a drive with this command line; returns the exit code."""
    return run_program(kind.program, lambda: run_live(kind(kind.parse(arguments))))


def run_live(drive: LiveDrive) -> int:
    """Run from start to end; returns the exit code, or raises the exception that ended it early."""
    with results_folder(drive.program, drive.out):
        _make_room(drive)
        return _run(drive)


def _run(drive: LiveDrive) -> int:
    early, outcome = None, Outcome("ended early", "interrupted")
    still = threading.Timer(PATIENCE, drive.progress.say, (
        "the drive is ending, and its files are being written",))
    still.daemon = True
    try:
        with Session(drive.out) as session:
            launched = session.launched(drive.vehicle, drive.driver,
                                        joined=not drive.options.any_port)
            try:
                drive.progress.status("starting roscore")
                launched.start_roscore()
                if drive.options.video:
                    begin_recording(launched.master_uri, drive.out / LOG / RECORDING)
                if why := launched.why_not_callers:
                    drive.progress.say(why[0] % why[1:])
                drive.progress.say(
                    "watch it, in another terminal: source devel/setup.bash; export "
                    f"ROS_MASTER_URI={launched.master_uri}; roslaunch sim_viewer viewer.launch")
                drive.bring_up(launched)
                outcome = drive.watch(launched)
            except (KeyboardInterrupt, RunError) as ended:
                early, outcome = ended, Outcome("ended early", str(ended) or "interrupted")
                still.start()
            if drive.film is not None:
                drive.film.stop()
            session.family.spared = drive.film.process_id if drive.film else None
            drive.end()
    except KeyboardInterrupt as ended:  # during the shutdown: results are still reported
        early = ended
    found = None
    drop_unread_output()  # Ctrl-C ends `tee`, too
    try:
        found = _report(drive, outcome)
    finally:
        with interruptible():
            _finish_film(drive, found)
        still.cancel()
    if early is not None:
        raise early
    for fault in filter(None, outcome.faults):
        print(f"{drive.program}: {fault}", file=sys.stderr)
    return NOT_PASSED if outcome.faults else PASSED


def _report(drive: LiveDrive, outcome: Outcome) -> dict | None:
    """Write and show the report, if there is anything to report, still without the video, which
    may fail to finish."""
    logs = sorted((drive.out / LOG).glob(drive.logs))
    log = [line for path in logs for line in read_log(path)]
    found = drive.figures(outcome, log)
    if found is None:
        return None
    add_marks(drive.out / RUN_LOG, drive.marks())
    found |= {"film": None, "versions": versions(Path(__file__).parent, log)}
    drive.summary = "\n".join(drive.write(found))
    drive.progress.say(f"\n{drive.summary}")
    return found


def _finish_film(drive: LiveDrive, found: dict | None) -> None:
    """Finish the video and add it to the report, or say why there is none; then list all files."""
    fault = drive.film.close() if drive.film else ""
    if fault:
        print(f"{drive.program}: no film: {fault}", file=sys.stderr)
    if found is None:
        return
    if drive.film and drive.film.codec:
        drive.write(found | {"film": drive.film.codec})
    if drive.options.video:
        write_run_page(
            drive.out / LOG / RECORDING, drive.out / RUN_PAGE,
            f"{drive.driver or drive.program}: {translated(found['outcome'])}", drive.summary,
            drive.out / "run.mp4",
            [drive.out / name for name in drive.writes if name.endswith(".png")], drive.curves(),
            marks_in(drive.out / RUN_LOG) or drive.marks())
    here = Path.cwd()
    made = [drive.out / name for name in drive.writes if (drive.out / name).exists()]
    shown = [str(path.relative_to(here) if path.is_relative_to(here) else path) for path in made]
    drive.progress.say(f"files: {'  '.join(shown)}")


def _make_room(drive: LiveDrive) -> None:
    """Move the previous run's results to EARLIER, so that the folder holds only this run's."""
    earlier = drive.out / EARLIER
    try:
        owned = (drive.out / name for name in drive.writes if name not in drive.stay)
        for path in filter(Path.exists, owned):
            earlier.mkdir(exist_ok=True)
            path.replace(earlier / path.name)
        for half in drive.out.glob("*.part.*"):  # from a video whose run was killed
            half.unlink()
    except OSError as error:
        if error.errno in SAID:
            raise
        raise RunError(f"--out {drive.out}: {error.strerror}") from error


LOOK_PERIOD = 0.05  # s, wall, between two checks of processes and samples
# s, wall, to wait for messages still in transit; after Ctrl-C nobody wants to wait
LAST_MESSAGE_TIME, INTERRUPTED_TIME = 10.0, 1.0


def waits_for_ever(words: Sequence[str]) -> bool:
    """Whether these arguments of roslaunch let the world wait without a limit, in lockstep."""
    values = dict(word.split(":=", 1) for word in words if ":=" in word)
    return re.fullmatch(r"0+(\.0*)?", values.get("lockstep_timeout", "1")) is not None


class CarDrive(LiveDrive):
    """Options are those of LiveDrive and `fast`; `drive` scores and keeps the samples."""

    def __init__(self, options: argparse.Namespace, course: CourseFile, drive: LapScorer):
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
        options = self.options
        if waits_for_ever(words):  # a program may stand at a breakpoint for as long as it likes
            options.startup_timeout = options.stuck_timeout = math.inf
        if options.fast:
            course = self.course
            begin_run_log(launched.master_uri, self.out / RUN_LOG, words, self.driver,
                          course.camera, course.commands, course.controllers)
        listened = self.course.sensors if self.fingerprints else ()
        self._observer = Observer(launched.master_uri, self.course.robot_name(words[2:]),
                                  self.course, lockstep=options.fast, listened=listened)
        launched.start("roslaunch", ["roslaunch", *words])
        if self.fingerprints:
            self.fingerprints.start()  # before time may begin
        self._observer.start()
        if self.film is not None:
            self.film.start()
        launched.wait_for(lambda: self._observer.missing, self._take_samples,
                          options.startup_timeout, self.progress.status, pause=0.0)

    def watch(self, launched: Launched) -> Outcome:
        """Follow the car until the drive is over."""
        while not self.drive.over:
            self._take_samples()
            now = self.drive.samples[-1].time
            self.progress.update(now, self.line)
            launched.check_time(now, self.options.stuck_timeout)
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
        if self.drive.samples:
            last = self.drive.samples[-1].time
            limit = LAST_MESSAGE_TIME if self.drive.over else INTERRUPTED_TIME
            try:
                self._count(last, limit)
            except KeyboardInterrupt:
                self._count(last, 0.0)
                raise
        self._observer.stop()

    def _count(self, until: float, limit: float) -> None:
        """Count what came up to this simulated time, s; what is in transit has `limit` s, wall."""
        self._frames = self._observer.count(until, limit)
        if self.fingerprints:
            self.sensor_sums = self.fingerprints.sums(until, limit)

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

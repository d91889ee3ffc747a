"""One case in its own process: starts the course and the submission, supervises, reports.

Poses and contacts come from the simulator's state log, a file that is not visible in the sandbox:
no topic and no node name is trusted.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import socket
import struct
import sys
import threading
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import rospy
from racecar_description.track.track_file import load_track_file
from std_srvs.srv import Empty

from evaluation.command_line import run_program
from evaluation.film import FINISH_TIME, WRITE_TIME
from evaluation.lap import LapScorer, Verdict, fingerprint
from evaluation.picture import path_picture, path_thumbnail, write_image
from evaluation.report import write_json
from marking import conduct, guard
from marking.bubblewrap import Kind
from marking.case_files import (
    OUTPUT,
    PATH_PICTURE,
    REPORT,
    STATE_LOG,
    THUMBNAIL,
    CaseFile,
    read_case,
    sample_of,
)
from marking.course_startup import LOOK_PERIOD, CourseStartup
from marking.points import did
from marking.rules import Rules, load_rules
from marking.submission_process import SubmissionProcess
from run_session import simulator
from run_session.failure import RunError
from run_session.files import Tail, check_space
from run_session.launch import LOOPBACK, Launched
from run_session.session import Session

BY_TIME = "by time"  # outcome: it does not answer each image, so it has to drive in real time


def bytes_below(folder: Path) -> int:
    """Total size of a folder's files, while other processes write there."""
    total = 0
    for path in folder.rglob("*"):
        with contextlib.suppress(FileNotFoundError):
            total += path.lstat().st_size
    return total


def write_report(folder: Path, case: CaseFile, drive: LapScorer, violations: Sequence[str],
                 fault: str, contacts: Mapping[str, int], again: bool = False,
                 exception: str = "") -> dict:
    """Write both into the folder; returns the report.

    `contacts`: for each touched model, the number of state log entries with the contact.
    `exception`: the program's, in one line.
    `again`: the case has to be driven again, in real time.
    """
    total, verdict = drive.total, drive.verdict
    why = drive.why
    if verdict is Verdict.DRIVING:
        why = f"{drive.driven_share:.0%} of the lap were driven in time"
    way = len(drive.laps) + (drive.driven_share if verdict is not Verdict.CLOSED else 0.0)
    report = {
        "outcome": "not allowed" if violations else "fault" if fault else BY_TIME if again else
                   "time is up" if verdict is Verdict.DRIVING else verdict.value,
        "violations": list(violations),
        "fault": fault,
        "exception": exception,
        "why": why,
        "laps_wanted": drive.wanted_laps,
        "laps_closed": len(drive.laps),
        "lap_times_s": [round(lap.time, 3) for lap in drive.laps],
        "driven_share": round(min(way / drive.wanted_laps, 1.0), 4),
        "distance_m": round(total.distance, 3),
        "rms_lateral_m": round(total.rms_lateral, 4),
        "max_lateral_m": round(total.max_lateral, 4),
        "mean_speed_m_s": round(total.distance / total.time, 4) if total.time else 0.0,
        "contacts": dict(sorted(contacts.items())),
        "drive_sha256": fingerprint(drive),
    }
    if drive.samples:
        shown = load_track_file(Path(case.track)), drive, case.driven().line_colour
        write_image(folder / PATH_PICTURE, path_picture(
            *shown, did(report), next(iter([*violations, exception or fault or why]))))
        write_image(folder / THUMBNAIL, path_thumbnail(*shown))
    write_json(report, folder / REPORT)
    return report


SETTLE_TIME = 1.0  # s, wall, for log entries still to come when a submission is stopped
ANSWER_TIME = 5.0  # s, wall, for an answer from the master or a node
FILM_TIME = WRITE_TIME + FINISH_TIME + 5.0  # s, wall: the encoder's own limits, and the node itself
MOST_LOGGED = 30e6  # bytes of all nodes' logs in one case
SIOCSIFFLAGS, IFF_UP = 0x8914, 1  # <linux/sockios.h>, <linux/if.h>


class CaseRunner:
    """One submission's drive of one case."""

    def __init__(self, session: Session, case: CaseFile, rules: Rules, folder: Path):
        self._session, self._case, self._folder = session, case, folder
        self._rules, self._limits = rules, rules.limits
        self._robot, self._scorer = case.robot(), case.scorer()
        self._state_log = Tail(folder / STATE_LOG)
        self._contacts: Counter[str] = Counter()
        self._fault, self._time_is_up, self._again = "", False, False

    def run(self) -> dict:
        """The case's report; RunError if the course itself could not be run, OSError if not all of
        it could be recorded."""
        launched = self._session.launched("car", alone=self._case.kind != Kind.NONE.value,
                                          environment=guard.environment(self._folder))
        self._log_folder = launched.log_folder
        course = CourseStartup(launched, self._case, self._folder, self._state_log.path)
        there, self._master_log = course.look_around(self._rules)
        self._conduct = conduct.Conduct(there)
        self._guard_record = Tail(self._folder / guard.RECORD)
        self._state_log.skip()
        guard.seal(self._folder, self._rules.may_call, Counter([simulator.UNPAUSE]))
        box = SubmissionProcess(
            Kind(self._case.kind), Path(self._case.submission), Path(self._case.program),
            self._limits, _environment(launched.master_uri), self._folder / OUTPUT)
        try:
            self._drive(launched, course, box)
            if self._conduct.violations:
                time.sleep(SETTLE_TIME)  # to report all of them, whichever was seen first
        finally:
            box.end()
        self._read_logs()
        if course.film:
            launched.end(course.film, FILM_TIME)
        check_space(self._folder)
        return write_report(self._folder, self._case, self._scorer, self._conduct.violations,
                            self._fault, self._contacts, self._again, box.exception())

    def _drive(self, launched: Launched, course: CourseStartup, box: SubmissionProcess) -> None:
        began = time.monotonic()
        while (missing := course.missing_link()) is not None:
            if self._is_over(launched, box):
                return
            if time.monotonic() - began > self._limits.start_s:
                if not course.has_driver():
                    self._fault = f"after {self._limits.start_s:g} s it had not {missing}"
                    return
                if not self._case.timed:  # it may be waiting for time to go on
                    self._again = True
                    return
                break
            time.sleep(LOOK_PERIOD)
        # In a thread: a submission may have replaced this service by its own, which may hang.
        threading.Thread(target=rospy.ServiceProxy(simulator.UNPAUSE, Empty), daemon=True).start()
        began = time.monotonic()
        while self._scorer.verdict is Verdict.DRIVING and not self._is_over(launched, box):
            time.sleep(LOOK_PERIOD)
            self._take_samples()
            if self._time_is_up:
                return
            if time.monotonic() - began > self._limits.wall_s:
                self._fault = f"it was not done after {self._limits.wall_s:g} s"
        if self._case.timed and self._scorer.verdict is Verdict.STALLED:
            missing = course.missing_link()
            self._fault = f"it had not {missing}" if missing else ""

    def _is_over(self, launched: Launched, box: SubmissionProcess) -> bool:
        """Whether the case is over: a violation or fault, or the submission's own end."""
        self._read_logs()
        if self._conduct.violations or self._fault or self._again:
            return True
        try:
            launched.check(None)
        except RunError as dead:
            self._read_logs()
            if not self._conduct.violations and "exit code 0" not in str(dead):
                raise  # the course crashed: the case cannot be marked
            self._conduct.see_end(str(dead).partition(" (")[0])
            return True
        if self._scorer.verdict is Verdict.DRIVING:
            self._fault = box.fault()
        return bool(self._fault)

    def _read_logs(self) -> None:
        self._take_samples()
        # The record first: a publisher that it names may be in the master's log, if only briefly.
        refused = [json.loads(line) for line in self._guard_record.lines()]
        self._conduct.see_registrations(self._master_log.lines())
        self._conduct.see_refusals(refused)
        if self._state_log.read + bytes_below(self._log_folder) > MOST_LOGGED:
            self._fault = f"it had more than {MOST_LOGGED / 1e6:g} MB logged"

    def _take_samples(self) -> None:
        """Score the state log's new lines."""
        for line in self._state_log.lines():
            entry = json.loads(line)
            if not self._case.timed and entry.get("unanswered", 0) > self._limits.unanswered:
                self._again = True
            sample = sample_of(entry, self._robot)
            if sample is not None and sample.time > self._limits.simulated_s:
                self._time_is_up = True
            elif sample is not None and self._scorer.verdict is Verdict.DRIVING:
                self._scorer.add(sample)
                self._contacts.update(other for pair in entry["contacts"] if self._robot in pair
                                      for other in pair if other != self._robot)


def _bring_loopback_up() -> None:
    """Bring up the loopback interface, which is down in a new network namespace."""
    with socket.socket() as any_socket:
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", IFF_UP))


def _environment(master_uri: str) -> dict[str, str]:
    """The environment variables that ROS and Python need, and nothing else of the teacher's."""
    kept = ("PYTHONPATH", "PATH", "ROS_PACKAGE_PATH", "ROS_ROOT", "ROS_DISTRO", "ROS_VERSION",
            "ROS_ETC_DIR", "ROS_HOME", "ROS_PYTHON_VERSION", "TURTLEBOT3_MODEL")
    return {"LANG": "C.UTF-8", "ROS_MASTER_URI": master_uri, "ROS_HOSTNAME": LOOPBACK,
            **{name: os.environ[name] for name in kept if name in os.environ}}


def main(folder: Path) -> int:
    """Run the case that FOLDER/case.json describes; returns the exit code."""
    return run_program("mark_drive", lambda: _run(folder))


def _run(folder: Path) -> int:
    case = read_case(folder)
    if Kind(case.kind) is not Kind.NONE:
        _bring_loopback_up()
    socket.setdefaulttimeout(ANSWER_TIME)
    with Session(folder) as session:
        CaseRunner(session, case, load_rules(Path(case.rules)), folder).run()
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))

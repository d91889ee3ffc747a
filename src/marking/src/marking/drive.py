"""One case in a process of its own: brings the course up, starts the submission, watches, reports.

Poses, contacts and calls come from the simulator's state log, a file that the sandbox does not
show: no topic and no node's name is believed.
"""

from __future__ import annotations

import fcntl
import json
import math
import os
import socket
import struct
import sys
import threading
import time
import xmlrpc.client
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import rosgraph
import rospy
from gazebo_msgs.srv import GetWorldProperties
from std_srvs.srv import Empty

from evaluation.lap import LapScorer, Sample, Verdict, fingerprint
from evaluation.picture import path_picture
from evaluation.session import names
from evaluation.session.connections import Connections, look_up
from evaluation.session.course_file import Course
from evaluation.session.failure import RunError
from evaluation.session.launch import Launched
from evaluation.session.observer import missing_connection
from evaluation.session.session import Session
from evaluation.track import build_track, load_track_file
from evaluation.trial.program import run_program
from evaluation.trial.report import write_json
from marking import conduct
from marking.box import Box, Kind
from marking.rules import Rules, load_rules
from marking.venues import driven

ME = "/judge"  # never registered at the master
STARTUP_LIMIT = 60.0  # s, wall, for the course
LOOK_PERIOD = 0.1  # s, wall
SETTLE_TIME = 1.0  # s, wall, for what is on its way when a submission is stopped
ANSWER_TIME = 5.0  # s, wall, for an answer of the master's or a node's
MOST_LOGGED = 20_000_000  # bytes of one log in one case
SIOCSIFFLAGS, IFF_UP = 0x8914, 1  # <linux/sockios.h>, <linux/if.h>
UNANSWERED_SAYS = "lockstep: no message on"
CASE, REPORT, PATH_PICTURE, OUTPUT = "case.json", "report.json", "path.png", "output.txt"


@dataclass(frozen=True)
class CaseFiles:
    """Where a case's things are."""

    submission: Path  # folder
    program: Path  # relative to it
    workspace: Path
    out: Path
    track: Path
    launch_args: tuple[str, ...]  # for roslaunch, name:=value


class MarkedDrive:
    """One submission's drive of one case."""

    def __init__(self, session: Session, course: Course, rules: Rules, kind: Kind,
                 files: CaseFiles):
        self._session, self._course, self._rules = session, course, rules
        self._kind, self._files, self._limits = kind, files, rules.limits
        self._track_file = load_track_file(files.track)
        self._scorer = LapScorer(build_track(self._track_file), rules.laps,
                                 off_course=course.off_course)
        self._state_log = _Tail(files.out / "state.jsonl")
        self._contacts: Counter[str] = Counter()
        self._fault = ""

    def run(self) -> dict:
        """The case's report; RunError if the course itself could not be run."""
        launched = self._session.launched("car")
        self._bring_up(launched)
        self._conduct = conduct.Conduct(self._look_around(launched))
        box = Box(self._kind, self._files.submission, self._files.program, self._files.workspace,
                  self._limits, _environment(launched.master_uri), self._files.out / OUTPUT)
        try:
            self._drive(launched, box)
            if self._conduct.violations:
                time.sleep(SETTLE_TIME)  # all of them, whichever was seen first
        finally:
            box.end()
        self._read_logs()
        return self._report(launched)

    def _bring_up(self, launched: Launched) -> None:
        launched.start_roscore()
        os.environ["ROS_MASTER_URI"] = launched.master_uri
        self._master = rosgraph.Master(ME, launched.master_uri)
        self._master.setParam("/gazebo/state_log", str(self._state_log.path))
        launched.start("roslaunch", ["roslaunch", *self._course.launch, *self._files.launch_args])
        robot = self._course.robot_name(self._files.launch_args)
        launched.wait_for(lambda: "the course", lambda: self._is_ready(robot), lambda _: None,
                          STARTUP_LIMIT, LOOK_PERIOD)

    def _is_ready(self, robot: str) -> bool:
        """The robot is there, and all that stands between it and a driver."""
        try:
            reply = rospy.ServiceProxy(names.WORLD, GetWorldProperties)()
            found = self._connections()
        except (rospy.ServiceException, OSError, xmlrpc.client.Error, rosgraph.MasterException):
            return False
        course = self._course
        needed = (course.camera, course.camera_info, course.odometry, *course.lockstep)
        return robot in reply.model_names and found.subscribers.get(course.commands) and all(
            found.publishers.get(topic) for topic in needed if topic != course.commands)

    def _look_around(self, launched: Launched) -> conduct.Course:
        """What is there before the submission; from here on every change is its doing."""
        publishers, subscribers, services = self._master.getSystemState()
        registered = [*publishers, *subscribers, *services]
        self._state_log.skip()
        self._master_log = _Tail(launched.log_folder / "latest" / "master.log")
        self._master_log.skip()
        rules = self._rules
        return conduct.Course(
            frozenset(node for _, nodes in registered for node in nodes),
            frozenset(name for name, _ in [*publishers, *subscribers]),
            frozenset(name for name, _ in services),
            frozenset(self._master.getParamNames()),
            frozenset([*rules.may_publish, self._course.commands]),
            frozenset(rules.may_call), Counter([names.UNPAUSE]))

    def _drive(self, launched: Launched, box: Box) -> None:
        began = time.monotonic()
        while (missing := self._missing_link()) is not None:
            if self._is_over(launched, box):
                return
            if time.monotonic() - began > self._limits.start_s:
                self._fault = f"after {self._limits.start_s:g} s it had not {missing}"
                return
            time.sleep(LOOK_PERIOD)
        # Beside the watching: a submission may have put a service of its own in that one's place.
        threading.Thread(target=rospy.ServiceProxy(names.UNPAUSE, Empty), daemon=True).start()
        began = time.monotonic()
        while self._scorer.verdict is Verdict.DRIVING and not self._is_over(launched, box):
            time.sleep(LOOK_PERIOD)
            self._take_samples()
            if self._scorer.samples and self._scorer.samples[-1].time > self._limits.simulated_s:
                return
            if time.monotonic() - began > self._limits.wall_s:
                unanswered = launched.count_said(UNANSWERED_SAYS)
                self._fault = f"it was not done after {self._limits.wall_s:g} s" + (
                    ", and left images without a command: answer every image" if unanswered else "")

    def _missing_link(self) -> str | None:
        """What the submission has not done yet, before time may begin."""
        try:
            found = self._connections()
        except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
            return "answered"
        course = self._course
        if not found.subscribers[course.camera]:
            return f"subscribed to {course.camera}"
        if not found.publishers[course.commands]:
            return f"advertised {course.commands}"
        missing = missing_connection(found, ME, course)
        return f"made {missing}" if missing else None

    def _connections(self) -> Connections:
        course = self._course
        return look_up(os.environ["ROS_MASTER_URI"], ME, (
            course.camera, course.camera_info, course.commands, course.odometry, *course.lockstep))

    def _is_over(self, launched: Launched, box: Box) -> bool:
        """Whether the submission did what ends a case, or has ended itself."""
        self._read_logs()
        if self._conduct.violations or self._fault:
            return True
        try:
            launched.check(None)
        except RunError as dead:
            self._read_logs()
            if not self._conduct.violations and "exit code 0" not in str(dead):
                raise  # it crashed: nothing to mark by
            self._conduct.see_end(str(dead).partition(" (")[0])
            return True
        if self._scorer.verdict is Verdict.DRIVING:
            self._fault = box.fault()
        return bool(self._fault)

    def _read_logs(self) -> None:
        self._take_samples()
        self._conduct.see_registrations(self._master_log.lines())
        if max(self._state_log.read, self._master_log.read) > MOST_LOGGED:
            self._fault = "it called the simulator or the master without end"

    def _take_samples(self) -> None:
        """Score the state log's new lines."""
        robot = self._course.robot_name(self._files.launch_args)
        for line in self._state_log.lines():
            values = json.loads(line)
            if "time" not in values:
                self._conduct.see_states([line])
            elif robot in values["poses"] and self._scorer.verdict is Verdict.DRIVING:
                self._scorer.add(_sample(values["time"], values["poses"][robot]))
                self._contacts.update(other for pair in values["contacts"] if robot in pair
                                      for other in pair if other != robot)

    def _report(self, launched: Launched) -> dict:
        drive, violations = self._scorer, self._conduct.violations
        total = drive.total
        verdict = drive.verdict
        why = drive.why
        if verdict is Verdict.DRIVING:
            why = f"{drive.driven_share:.0%} of the lap were driven in time"
        way = len(drive.laps) + (drive.driven_share if verdict is not Verdict.CLOSED else 0.0)
        report = {
            "outcome": "not allowed" if violations else "fault" if self._fault else
                       verdict.value if verdict is not Verdict.DRIVING else "time is up",
            "violations": violations,
            "fault": self._fault,
            "why": "" if verdict is Verdict.CLOSED else why,
            "laps_wanted": drive.wanted_laps,
            "laps_closed": len(drive.laps),
            "lap_times_s": [round(lap.time, 3) for lap in drive.laps],
            "driven_share": round(min(way / drive.wanted_laps, 1.0), 4),
            "distance_m": round(total.distance, 3),
            "rms_lateral_m": round(total.rms_lateral, 4),
            "max_lateral_m": round(total.max_lateral, 4),
            "mean_speed_m_s": round(total.distance / total.time, 4) if total.time else 0.0,
            "contacts": dict(sorted(self._contacts.items())),
            "drive_sha256": fingerprint(drive),
        }
        if drive.samples:
            picture = path_picture(self._track_file, drive, report["outcome"], report["why"])
            cv2.imwrite(str(self._files.out / PATH_PICTURE), picture)
        write_json(report, self._files.out / REPORT)
        return report


class _Tail:
    """Whole new lines of a file that grows."""

    def __init__(self, path: Path):
        self.path, self.read, self._rest = path, 0, b""  # bytes read

    def lines(self) -> list[str]:
        try:
            with self.path.open("rb") as file:
                file.seek(self.read)
                data = file.read()
        except FileNotFoundError:
            return []
        self.read += len(data)
        *lines, self._rest = (self._rest + data).split(b"\n")
        return [line.decode("utf-8", "replace") for line in lines]

    def skip(self) -> None:
        """Leave out what is there."""
        self.lines()


def bring_loopback_up() -> None:
    """In a new network namespace it is down."""
    with socket.socket() as any_socket:
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", IFF_UP))


def _environment(master_uri: str) -> dict[str, str]:
    """What ROS and Python need, and nothing of the teacher's."""
    kept = ("PYTHONPATH", "PATH", "ROS_PACKAGE_PATH", "ROS_ROOT", "ROS_DISTRO", "ROS_VERSION",
            "ROS_ETC_DIR", "ROS_PYTHON_VERSION", "TURTLEBOT3_MODEL")
    return {"LANG": "C.UTF-8", "ROS_MASTER_URI": master_uri, "ROS_HOSTNAME": "localhost",
            **{name: os.environ[name] for name in kept if name in os.environ}}


def _sample(seconds: float, pose: Sequence[float]) -> Sample:
    x, y, _, qx, qy, qz, qw = pose
    return Sample(seconds, x, y, math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz)))


def main(folder: Path) -> int:
    """Run the case that FOLDER/case.json describes; returns the exit code."""
    return run_program("mark_drive", lambda: _run(folder))


def _run(folder: Path) -> int:
    values = json.loads((folder / CASE).read_text(encoding="utf-8"))
    rules, kind = load_rules(Path(values["rules"])), Kind(values["kind"])
    course = driven(values["course"])
    socket.setdefaulttimeout(ANSWER_TIME)
    if kind is not Kind.NONE:
        bring_loopback_up()
    files = CaseFiles(Path(values["submission"]), Path(values["program"]), Path(sys.prefix).parent,
                      folder, Path(values["track"]), tuple(values["launch_args"]))
    with Session(folder) as session:
        MarkedDrive(session, course, rules, kind, files).run()
    return 0

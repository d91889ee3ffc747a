"""`make mark`: each submission drives each case in a sandbox of its own, and gets points."""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import math
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evaluation.laps import lit_drive
from evaluation.laps.disturbance import Disturbance
from evaluation.session.failure import RunError
from evaluation.session.resources import find_package
from evaluation.session.session import Session
from evaluation.track import load_track
from evaluation.trial.command_line import Parser
from evaluation.trial.protocol import Case, Trial
from marking.box import WORKSPACE, Kind, available, namespace
from marking.case_files import CaseFile
from marking.course_up import STARTUP_LIMIT
from marking.mark import Mark, by_student
from marking.points import mean, points_of
from marking.rules import Rules, load_rules
from marking.sheets import write_marks, write_student_pages
from marking.submissions import find_submissions, prepare
from marking.text import one_line
from marking.unpacking import UnpackError
from marking.venues import COURSES, Venue, course_venue, driven

NOT_RUN = "not run"
TRIES = 2  # of a case in which the course itself could not be run


@dataclass(frozen=True)
class MarkedCase(Case):
    """One submission on one track with one seed."""

    student: str
    track: int  # 0: the course's own
    seed: int


class MarkingTrial(Trial):
    """Submissions times tracks times seeds."""

    program = "mark"
    does = "Mark a folder of submissions; each drives in a sandbox."
    good = "every case could be run"
    writes = "marks.csv, marks.html, report.json and a folder of each student"

    def add_options(self, parser: Parser) -> None:
        parser.add_argument("--submissions", type=Path, required=True, metavar="DIR",
                            help="a file, folder, zip or tar of each student")
        parser.add_argument("--rules", type=Path, metavar="YAML",
                            help="what is driven and how it is marked (config/marking.yaml)")
        parser.add_argument("--course", metavar="NAME",
                            help=f"{', '.join(COURSES)}; replaces that of the rules")
        parser.add_whole("--seeds", 0, "cases on each track; 0: as the rules say", variable="SEEDS")
        parser.add_argument("--film", action="store_true", help="also film every drive")
        parser.add_argument("--no-sandbox", action="store_true",
                            help="run submissions unprotected, where the machine allows no sandbox")

    def check(self, options: argparse.Namespace) -> None:
        path = (options.rules or find_package("marking") / "config" / "marking.yaml").resolve()
        rules = load_rules(path)
        course = options.course or rules.course
        if course not in COURSES:
            given = "--course (COURSE=)" if options.course else f"{path}: course:"
            raise RunError(f"{given} must be one of {', '.join(COURSES)}, is {course!r}")
        for track in rules.tracks:
            load_track(Path(track))
        self._rules = dataclasses.replace(rules, course=course,
                                          seeds=options.seeds or rules.seeds)
        self._rules_path, self._out, self._film = path, options.out, options.film
        self._rules_digest = hashlib.sha256(
            f"{course} {path.read_text(encoding='utf-8')}".encode()).hexdigest()
        self._submissions = {each.student: each for each in find_submissions(options.submissions)}
        self._kind = Kind.NONE if options.no_sandbox else available()
        self._refuse_what_the_sandbox_shows(options)

    def _refuse_what_the_sandbox_shows(self, options: argparse.Namespace) -> None:
        workspace = Path(sys.prefix).parent
        for what, path in (("--submissions", options.submissions), ("--out", options.out),
                           ("--rules", options.rules)):
            inside = path and any(path.resolve().is_relative_to(workspace / name)
                                  for name in WORKSPACE)
            if inside and self._kind is not Kind.NONE:
                raise RunError(f"{what} {path}: every submission could read it there; put it "
                               f"outside {' '.join(str(workspace / name) for name in WORKSPACE)}")

    def cases(self, options: argparse.Namespace) -> list[MarkedCase]:
        rules = self._rules
        return [MarkedCase(f"{student}/{track}-{seed}", student, track, seed)
                for student in self._submissions for track in range(1 + len(rules.tracks))
                for seed in range(rules.first_seed, rules.first_seed + rules.seeds)]

    def setup(self, session: Session, case: MarkedCase) -> None:
        self._session, self._case, self._fault = session, case, ""
        folder = self._folder(case)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            prepared = prepare(self._submissions[case.student], folder / "submission",
                               self._rules.program)
        except (UnpackError, OSError) as error:
            self._fault = one_line(str(error))
            return
        rules, venue = self._rules, self._venue(case)
        draw = _draw(rules, case.seed)
        world = lit_drive.write_world(venue.world, venue.models, draw.light, folder / "world")
        course = driven(rules.course)
        x, y, yaw = draw.start(load_track(venue.track))
        arguments = {
            "world_name": world, "x_pos": f"{x:.6f}", "y_pos": f"{y:.6f}", "yaw": f"{yaw:.6f}",
            "seed": case.seed, "gui": "false", "paused": "true", "real_time_factor": 0,
            "pub_clock_frequency": 30, "lockstep": ",".join(course.lockstep),
            "lockstep_timeout": f"{rules.limits.answer_s:g}",
            **dict(zip(("camera_width", "camera_height"), rules.camera, strict=False))}
        CaseFile(str(self._rules_path), self._kind.value, rules.course, rules.laps,
                 str(prepared.folder), str(prepared.program), str(venue.track), self._film,
                 [f"{name}:={value}" for name, value in arguments.items()]).write(folder)
        self._models = ":".join(str(each) for each in (
            folder / "world" / "models", venue.models, os.environ.get(lit_drive.MODEL_PATH, "")))

    def run(self) -> dict:
        """The report of the drive, or what went wrong before it."""
        if self._fault:
            return {"outcome": "fault", "violations": [], "fault": self._fault}
        folder = self._folder(self._case)
        command = [*namespace(self._kind), sys.executable, "-P", "-m", "marking.drive",
                   str(folder)]
        environment = {**os.environ, lit_drive.MODEL_PATH: self._models,
                       "ROS_HOSTNAME": "localhost"}
        limits = self._rules.limits
        limit = limits.start_s + limits.wall_s + 3 * STARTUP_LIMIT
        for _ in range(TRIES):
            try:
                drive = self._session.start_drive(command, folder, environment)
                return drive.report(limit, self._case.name)
            except RunError as error:
                failure = str(error)
        return {"outcome": NOT_RUN, "violations": [], "fault": failure}

    def score(self, record: dict) -> Mark:
        case = self._case
        points, lost = points_of(record, self._rules.points)
        folder = "" if self._fault else str(self._folder(case).relative_to(self._out))
        return Mark(case.name, case.student, _case_name(case), record["outcome"], points,
                    tuple(map(one_line, lost)), folder)

    def passed(self, results: Sequence[Mark]) -> bool:
        return all(mark.outcome != NOT_RUN for mark in results)

    def line(self, result: Mark) -> str:
        why = f": {result.lost[0]}" if result.lost else ""
        return f"{result.name}: {result.points:g} points, {result.outcome}{why}"

    def table(self, results: Sequence[Mark]) -> str:
        rows = [f"{mean([mark.points for mark in marks]):7.2f}  {student}"
                for student, marks in by_student(results).items()]
        warned = [] if self._kind is not Kind.NONE else ["without a sandbox (--no-sandbox)"]
        return "\n".join([" points  student", *rows, *warned])

    def values(self, results: Sequence[Mark]) -> dict:
        return {"sandbox": self._kind.value, "rules_sha256": self._rules_digest,
                "marks": [dataclasses.asdict(mark) for mark in results]}

    def from_values(self, values: dict) -> list[Mark]:
        if values["rules_sha256"] != self._rules_digest:
            raise RunError(f"{self._out}: was marked by other rules; choose another --out")
        return [Mark(**{**each, "lost": tuple(each["lost"])}) for each in values["marks"]
                if each["outcome"] != NOT_RUN]

    def pictures(self, results: Sequence[Mark], out: Path) -> list[str]:
        marks = by_student(results)
        write_student_pages(marks, self._rules, out)
        write_marks(marks, self._rules, self._kind, out)
        return []

    def _folder(self, case: MarkedCase) -> Path:
        return self._out / "cases" / case.student / _case_name(case)

    def _venue(self, case: MarkedCase) -> Venue:
        track = Path(self._rules.tracks[case.track - 1]) if case.track else None
        return course_venue(self._rules.course, track, self._folder(case))


def _case_name(case: MarkedCase) -> str:
    return f"track{case.track}-seed{case.seed}"


def _draw(rules: Rules, seed: int) -> Disturbance:
    """Start and light of a case, evenly distributed within the rules' bounds."""
    random = np.random.default_rng(seed)
    most, turn = rules.start_sideways_m, math.radians(rules.start_turn_deg)
    return Disturbance(sideways=random.uniform(-most, most), along=0.0,
                       turn=random.uniform(-turn, turn), camera_noise=0.0,
                       light=random.uniform(*rules.light))

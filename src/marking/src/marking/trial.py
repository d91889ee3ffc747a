"""`make mark`: each submission drives each case in a sandbox of its own, and gets points."""

from __future__ import annotations

import argparse
import dataclasses
import errno
import hashlib
import os
import shutil
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from racecar_description.track.closed_line import load_track

from evaluation.command_line import Parser
from evaluation.lap_trial import MODEL_PATH
from evaluation.trial import REPORT, Case, ReportedTrial
from marking.bubblewrap import Kind, available, hidden, namespace, shown
from marking.case_files import COURSES, CaseFile, make_scene
from marking.case_runner import BY_TIME
from marking.course_startup import STARTUP_LIMIT
from marking.marks import (
    MARKS,
    PAGE,
    Mark,
    by_student,
    mean,
    points_of,
    write_marks,
    write_student_pages,
)
from marking.rules import load_rules
from marking.submissions import UnpackError, digest, find_submissions, one_line, prepare
from run_session.failure import RunError
from run_session.files import find_package
from run_session.launch import LOOPBACK
from run_session.session import Session

NOT_RUN, SUBMISSION = "not run", "submission"
TIMED = "driven in real time: it did not answer each image with a command"
SANDBOXED = {kind.value: "without a sandbox" if kind is Kind.NONE else "in a sandbox"
             for kind in Kind}
TRIES = 3  # of a case in which the course itself could not be run


@dataclass(frozen=True)
class MarkedCase(Case):
    """One submission on one track with one seed."""

    student: str
    track: int  # 0: the course's own
    seed: int


class MarkingTrial(ReportedTrial):
    """One case for each combination of submission, track and seed."""

    package, program = "marking", "mark"
    does = "Mark a folder of submissions; each drives in a sandbox."
    good = "every case could be run"
    writes = "marks.csv, marks.html, report.json and a folder of each student"

    def add_options(self, parser: Parser) -> None:
        parser.add_argument("--submissions", type=Path, metavar="DIR",
                            help="a file, folder, zip or tar of each student")
        parser.add_argument("--rules", type=Path, metavar="YAML",
                            help="what is driven and how it is marked (config/marking.yaml)")
        parser.add_argument("--course", metavar="NAME",
                            help=f"{', '.join(COURSES)}; replaces that of the rules")
        parser.add_whole("--seeds", 0, "cases on each track; 0: as the rules say")
        parser.add_argument("--film", action="store_true", help="also film every drive")
        parser.add_argument("--no-sandbox", action="store_true",
                            help="run submissions unprotected, where the machine allows no sandbox")

    def check(self, options: argparse.Namespace) -> None:
        if options.submissions is None:
            raise RunError("--submissions (SUBMISSIONS=) is missing: a folder of submissions")
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
        self._rules_digest = _digest(course, [path, *map(Path, rules.tracks)])
        self._submissions = {each.student: each for each in find_submissions(options.submissions)}
        self._kind = Kind.NONE if options.no_sandbox else available()
        self._refuse_what_the_sandbox_shows(options)

    def _refuse_what_the_sandbox_shows(self, options: argparse.Namespace) -> None:
        for what, path in (("--submissions", options.submissions), ("--out", options.out),
                           ("--rules", options.rules)):
            seen = path and any(map(path.resolve().is_relative_to, shown())) and not any(
                map(path.resolve().is_relative_to, hidden()))
            if seen and self._kind is not Kind.NONE:
                raise RunError(f"{what} {path}: every submission could read it there; put it "
                               f"outside {' '.join(map(str, shown()))}")

    def cases(self, options: argparse.Namespace) -> list[MarkedCase]:
        rules = self._rules
        return [MarkedCase(f"{student}/{track}-{seed}", student, track, seed)
                for student in self._submissions for track in range(1 + len(rules.tracks))
                for seed in range(rules.first_seed, rules.first_seed + rules.seeds)]

    def setup(self, session: Session, case: MarkedCase) -> None:
        self._session, self._case, self._fault = session, case, ""
        folder = self._folder(case)
        folder.mkdir(parents=True, exist_ok=True)
        self._digest = digest(self._submissions[case.student].source)
        try:
            program = prepare(self._submissions[case.student], folder / SUBMISSION,
                              self._rules.program)
        except (UnpackError, OSError) as error:
            if isinstance(error, OSError) and error.errno == errno.ENOSPC:
                raise
            self._fault = one_line(str(error))
            return
        self._scene = scene = make_scene(
            self._rules, case.track, case.seed, self._out / "scenes" / _case_name(case))
        self._file = CaseFile(
            str(self._rules_path), self._kind.value, self._rules.course, self._rules.laps,
            str(folder / SUBMISSION), str(program), str(scene.track), self._film,
            scene.launch_args)

    def run(self) -> dict:
        """The report of the drive, or what prevented it."""
        if self._fault:
            return {"outcome": "fault", "violations": [], "fault": self._fault}
        report = self._drive(self._file)
        if report["outcome"] == BY_TIME:
            report = self._drive(self._file.by_time(self._rules.limits)) | {"note": TIMED}
        return report

    def _drive(self, file: CaseFile) -> dict:
        folder = self._folder(self._case)
        file.write(folder)
        command = [*namespace(self._kind), sys.executable, "-P", "-m", "marking.case_runner",
                   str(folder)]
        environment = {**os.environ, MODEL_PATH: self._scene.models, "ROS_HOSTNAME": LOOPBACK}
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
        shutil.rmtree(self._folder(case) / SUBMISSION, ignore_errors=True)  # the original is kept
        points, lost = points_of(record, self._rules.points)
        folder = "" if self._fault else str(self._folder(case).relative_to(self._out))
        return Mark(case.name, case.student, _case_name(case), record["outcome"], points,
                    tuple(map(one_line, lost)), folder, record.get("note", ""),
                    self._digest)

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

    def earlier(self, options: argparse.Namespace) -> list[Mark]:
        """Results so far; it is no error if there are none."""
        return super().earlier(options) if (options.out / REPORT).exists() else []

    def from_values(self, values: dict) -> list[Mark]:
        if values["rules_sha256"] != self._rules_digest:
            raise RunError(f"{self._out}: was marked by other rules or tracks; "
                           "choose another --out")
        if (values["sandbox"] == Kind.NONE.value) != (self._kind is Kind.NONE):
            raise RunError(f"{self._out}: was marked {SANDBOXED[values['sandbox']]}, this run is "
                           f"{SANDBOXED[self._kind.value]}; choose another --out")
        marks = [Mark(**{**each, "lost": tuple(each["lost"])}) for each in values["marks"]
                 if each["outcome"] != NOT_RUN]
        changed = {student for student, rows in by_student(marks).items()
                   if (there := self._submissions.get(student))
                   and {digest(there.source)} != {mark.submission_sha256 for mark in rows}}
        for student in sorted(changed):
            print(f"{student}: the submission has changed, it is marked again", flush=True)
        return [mark for mark in marks if mark.student not in changed]

    def pictures(self, results: Sequence[Mark], out: Path) -> list[str]:
        marks = by_student(results)
        write_student_pages(marks, self._rules, out)
        write_marks(marks, self._rules, self._kind, out)
        print(f"the marks: {out / MARKS}, {out / PAGE}, and for each student a page below "
              f"{out / 'students'}", flush=True)
        return []

    def _folder(self, case: MarkedCase) -> Path:
        return self._out / "cases" / case.student / _case_name(case)


def _digest(course: str, files: Sequence[Path]) -> str:
    """SHA-256 of all that a mark depends on besides the submission."""
    sums = hashlib.sha256(course.encode())
    for file in files:
        sums.update(hashlib.sha256(file.read_bytes()).digest())
    return sums.hexdigest()


def _case_name(case: MarkedCase) -> str:
    return f"track{case.track}-seed{case.seed}"

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
from evaluation.report import table
from evaluation.run_page import RECORDING, RUN_PAGE, write_run_page
from evaluation.trial import Case, Trial
from marking.bubblewrap import Kind, available, hidden, namespace, shown
from marking.case_files import (
    COURSES,
    FILM,
    OUTPUT,
    PATH_PICTURE,
    THUMBNAIL,
    CaseFile,
    Scene,
    make_scene,
)
from marking.case_runner import BY_TIME
from marking.course_startup import STARTUP_LIMIT
from marking.marks import (
    MARKS,
    PAGE,
    SHOWN,
    STUDENTS,
    student_file,
    write_marks,
    write_student_pages,
)
from marking.points import NOT_RUN, Mark, by_student, case_title, did, mean, points_of, sentence
from marking.rules import load_rules
from marking.submissions import (
    Submission,
    UnpackError,
    digest,
    find_submissions,
    one_line,
    prepare,
)
from run_session.failure import RunError
from run_session.files import find_package
from run_session.launch import LOOPBACK
from run_session.session import Session

SUBMISSION = "submission"
TIMED = "driven in real time: it did not answer each image with a command"
SANDBOXED = {kind.value: "without a sandbox" if kind is Kind.NONE else "in a sandbox"
             for kind in Kind}
TRIES = 3  # of a case in which the course itself could not be run


@dataclass(frozen=True, kw_only=True)
class MarkedCase(Case):
    """One submission on one track with one seed."""

    student: str
    track: int  # 0: the course's own


@dataclass(frozen=True)
class Record:
    """What happened in a case."""

    case: MarkedCase
    submission_sha256: str
    report: dict  # of the drive, or what prevented it
    driven: bool = True  # False: there was nothing to drive


class MarkingTrial(Trial):
    """One case for each combination of submission, track and seed."""

    package, program = "marking", "mark"
    does = "Mark a folder of submissions; each drives in a sandbox."
    good = "every case could be run"
    writes = "marks.csv, marks.html, report.json and a folder of each student"
    begins_anew = True

    def add_options(self, parser: Parser) -> None:
        self.add_source(parser)
        parser.add_argument("--rules", type=Path, metavar="YAML",
                            help="what is driven and how it is marked (config/marking.yaml)")
        parser.add_argument("--course", metavar="NAME",
                            help=f"{', '.join(COURSES)}; replaces that of the rules")
        parser.add_whole("--seeds", 0, "cases on each track; 0: as the rules say")
        parser.add_argument("--film", action="store_true", help="also film every drive")
        parser.add_argument("--no-sandbox", action="store_true",
                            help="run submissions unprotected, where the machine allows no sandbox")

    def add_source(self, parser: Parser) -> None:
        """Add the option that names the submissions."""
        parser.add_argument("--submissions", type=Path, metavar="DIR",
                            help="a file, folder, zip or tar of each student")

    def find(self, options: argparse.Namespace) -> list[Submission]:
        """The submissions; RunError if there are none."""
        if options.submissions is None:
            raise RunError("--submissions (SUBMISSIONS=) is missing: a folder of submissions")
        return find_submissions(options.submissions)

    def sandbox(self, options: argparse.Namespace) -> Kind:
        """The sandbox, if any is allowed; RunError if not, or if it shows what must be hidden."""
        if options.no_sandbox:
            return Kind.NONE
        _refuse_what_the_sandbox_shows(("--submissions (SUBMISSIONS=)", options.submissions),
                                       (self.named("out"), options.out),
                                       ("--rules (RULES=)", options.given_rules))
        return available()

    def check(self, options: argparse.Namespace) -> None:
        found = self.find(options)
        path = (options.rules or find_package("marking") / "config" / "marking.yaml").resolve()
        rules = load_rules(path)
        course = options.course or rules.course
        if course not in COURSES:
            given = "--course (COURSE=)" if options.course else f"{path}: course:"
            raise RunError(f"{given} must be one of {', '.join(COURSES)}, is {course!r}")
        for track in rules.tracks:
            load_track(Path(track))
        options.given_rules, options.rules_path = options.rules, path
        options.rules = dataclasses.replace(rules, course=course,
                                            seeds=options.seeds or rules.seeds)
        options.rules_sha256 = _digest(course, [path, *map(Path, rules.tracks)])
        options.found = {each.student: each for each in found}
        options.kind = self.sandbox(options)

    def cases(self, options: argparse.Namespace) -> list[MarkedCase]:
        rules = options.rules
        return [MarkedCase(f"{student}/{track}-{seed}", student=student, track=track, seed=seed)
                for student in options.found for track in range(1 + len(rules.tracks))
                for seed in range(rules.first_seed, rules.first_seed + rules.seeds)]

    def drive(self, session: Session, case: MarkedCase) -> Record:
        options = self.options
        folder, submission = _folder(options.out, case), options.found[case.student]
        folder.mkdir(parents=True, exist_ok=True)
        sha256 = digest(submission.source)
        try:
            program = prepare(submission, folder / SUBMISSION, options.rules.program)
        except (UnpackError, OSError) as error:
            if isinstance(error, OSError) and error.errno == errno.ENOSPC:
                raise
            fault = {"outcome": "fault", "violations": [], "fault": one_line(str(error))}
            return Record(case, sha256, fault, driven=False)
        scene = make_scene(options.rules, case.track, case.seed,
                           options.out / "scenes" / _case_name(case))
        file = CaseFile(
            str(options.rules_path), options.kind.value, options.rules.course, options.rules.laps,
            str(folder / SUBMISSION), str(program), str(scene.track), options.film,
            scene.launch_args)
        report = self._drive(session, case, scene, file)
        if report["outcome"] == BY_TIME:
            again = file.by_time(options.rules.limits)
            report = self._drive(session, case, scene, again) | {"note": TIMED}
        return Record(case, sha256, report)

    def _drive(self, session: Session, case: MarkedCase, scene: Scene, file: CaseFile) -> dict:
        """The report of the drive, or what prevented it."""
        folder = _folder(self.options.out, case)
        for made in (OUTPUT, PATH_PICTURE, THUMBNAIL, FILM, RECORDING):  # of an earlier drive
            (folder / made).unlink(missing_ok=True)
        file.write(folder)
        command = [*namespace(self.options.kind), sys.executable, "-P", "-m",
                   "marking.case_runner", str(folder)]
        environment = {**os.environ, MODEL_PATH: scene.models, "ROS_HOSTNAME": LOOPBACK}
        limits = self.options.rules.limits
        limit = limits.start_s + limits.wall_s + 3 * STARTUP_LIMIT
        how = "driving in real time" if file.timed else "driving"
        for left in reversed(range(TRIES)):
            session.progress.say(f"{case.student}: {file.course}, track {case.track}, seed "
                                 f"{case.seed}: {how}, at most {limit:g} s")
            try:
                return session.drive(command, folder, case.name, limit, environment)
            except RunError as error:
                failure = str(error)
            if left:
                session.progress.say(failure)
        return {"outcome": NOT_RUN, "violations": [], "fault": failure}

    def judge(self, record: Record) -> Mark:
        case, report, out = record.case, record.report, self.options.out
        folder = _folder(out, case)
        shutil.rmtree(folder / SUBMISSION, ignore_errors=True)  # the original is kept
        points, lost = points_of(report, self.options.rules.points)
        lost = tuple(map(one_line, lost))
        mark = Mark(case.name, case.student, _case_name(case), report["outcome"], points, lost,
                    str(folder.relative_to(out)) if record.driven else "",
                    report.get("note", ""), record.submission_sha256, did(report))
        if record.driven:
            kept = {made: student_file(out, case.student, mark.case, made) for made in SHOWN}
            kept[RUN_PAGE].parent.mkdir(parents=True, exist_ok=True)
            write_run_page(folder / RECORDING, kept[RUN_PAGE],
                           f"{case.student}, {case_title(mark.case)}",
                           sentence(mark, self.options.rules.points.most),
                           folder / FILM, [folder / PATH_PICTURE])
            for made in (PATH_PICTURE, THUMBNAIL, FILM):
                kept[made].unlink(missing_ok=True)
                if (folder / made).exists():
                    (folder / made).replace(kept[made])
        return mark

    def passed(self, results: Sequence[Mark]) -> bool:
        return all(mark.outcome != NOT_RUN for mark in results)

    def line(self, result: Mark) -> str:
        rules = self.options.rules
        one_case = rules.seeds * (1 + len(rules.tracks)) == 1
        who = result.student if one_case else f"{result.student}, {case_title(result.case)}"
        return f"{who}: {sentence(result, rules.points.most)}"

    def table(self, results: Sequence[Mark]) -> str:
        rows = [(f"{mean([mark.points for mark in marks]):7.2f}", student)
                for student, marks in by_student(results).items()]
        warned = [] if self.options.kind is not Kind.NONE else ["without a sandbox (--no-sandbox)"]
        return "\n".join([table([(" points", "student"), *rows], left=(1,), names=(1,)), *warned])

    def values(self, results: Sequence[Mark]) -> dict:
        return {"sandbox": self.options.kind.value, "rules_sha256": self.options.rules_sha256,
                "marks": [dataclasses.asdict(mark) for mark in results]}

    def from_values(self, values: dict) -> list[Mark]:
        if values["rules_sha256"] != self.options.rules_sha256:
            raise RunError(f"{self.options.out}: was marked by other rules or tracks; "
                           f"choose another {self.named('out')}")
        if (values["sandbox"] == Kind.NONE.value) != (self.options.kind is Kind.NONE):
            raise RunError(
                f"{self.options.out}: was marked {SANDBOXED[values['sandbox']]}, this run is "
                f"{SANDBOXED[self.options.kind.value]}; choose another {self.named('out')}")
        marks = [Mark(**{**each, "lost": tuple(each["lost"])}) for each in values["marks"]
                 if each["outcome"] != NOT_RUN]
        changed = {student for student, rows in by_student(marks).items()
                   if (there := self.options.found.get(student))
                   and {digest(there.source)} != {mark.submission_sha256 for mark in rows}}
        for student in sorted(changed):
            print(f"{student}: the submission has changed, it is marked again", flush=True)
        return [mark for mark in marks if mark.student not in changed]

    def pictures(self, results: Sequence[Mark], out: Path) -> list[str]:
        marks = by_student(results)
        write_student_pages(marks, self.options.rules, out)
        write_marks(marks, self.options.rules, self.options.kind, out)
        print(f"the marks: {out / MARKS}, {out / PAGE}, and for each student a page below "
              f"{out / STUDENTS}", flush=True)
        return []


def _refuse_what_the_sandbox_shows(*given: tuple[str, Path | None]) -> None:
    for what, path in given:
        if path and any(map(path.resolve().is_relative_to, shown())) and not any(
                map(path.resolve().is_relative_to, hidden())):
            raise RunError(f"{what} {path}: every submission could read it there; put it "
                           f"outside {' '.join(map(str, shown()))}")


def _folder(out: Path, case: MarkedCase) -> Path:
    return out / "cases" / case.student / _case_name(case)


def _digest(course: str, files: Sequence[Path]) -> str:
    """SHA-256 of all that a mark depends on besides the submission."""
    sums = hashlib.sha256(course.encode())
    for file in files:
        sums.update(hashlib.sha256(file.read_bytes()).digest())
    return sums.hexdigest()


def _case_name(case: MarkedCase) -> str:
    return f"track{case.track}-seed{case.seed}"

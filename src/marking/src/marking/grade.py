"""`make grade`: one submission, by the judge of `make mark`, with JUnit XML and Markdown for CI."""

from __future__ import annotations

import argparse
import os
import re
import tempfile
import xml.etree.ElementTree as Xml
from collections.abc import Sequence
from html import escape
from pathlib import Path

from terminal_language import translated

from evaluation.command_line import Parser
from marking.bubblewrap import Kind, available
from marking.marks import STUDENT_PAGE, STUDENTS, write_student_pages
from marking.points import (
    NOT_RUN,
    Mark,
    by_student,
    case_title,
    colon,
    figure,
    headline,
    losses,
    mean,
    sentence,
)
from marking.submissions import Submission, UnpackError, prepare, submission_at
from marking.trial import MarkingTrial
from run_session.failure import RunError
from run_session.files import write_whole

JUNIT, SUMMARY = "junit.xml", "summary.md"
IN_MARKDOWN = re.compile(r"([\\`*_\[\]|~#])")  # would be read as markup


class GradingTrial(MarkingTrial):
    """One submission on each track with each seed."""

    program = "grade"
    does = "Grade one submission, as make mark does those of a class."
    good = "the points reach the pass line of the rules"
    writes = f"{SUMMARY}, {JUNIT}, report.json and the student's page"

    def add_source(self, parser: Parser) -> None:
        parser.add_argument("--file", type=Path, metavar="FILE",
                            help="a Python file, a folder, a zip or a tar")

    def find(self, options: argparse.Namespace) -> list[Submission]:
        if options.file is None:
            raise RunError("--file (FILE=) is missing: the program to grade")
        return [submission_at(options.file)]

    def sandbox(self, options: argparse.Namespace) -> Kind:
        """Without one where there is none: whoever grades one program knows whose it is."""
        options.submissions = None  # others' are not there to be read
        try:
            if not options.no_sandbox:
                available()
        except RunError as none:
            if os.getuid() == 0 and os.environ.get("SUDO_USER"):
                raise  # nobody's program runs unprotected as root
            print(f"{str(none).partition('; ')[0]}; the program runs unprotected", flush=True)
            options.no_sandbox = True
        return super().sandbox(options)

    def check(self, options: argparse.Namespace) -> None:
        for made in (JUNIT, SUMMARY):  # of an earlier submission
            (options.out / made).unlink(missing_ok=True)
        super().check(options)
        self.options = options
        [submission] = options.found.values()
        with tempfile.TemporaryDirectory() as folder:
            try:
                prepare(submission, Path(folder) / "submission", options.rules.program)
            except UnpackError as error:
                lost = f"-{figure(options.rules.points.most)}: {error}"
                options.out.mkdir(parents=True, exist_ok=True)
                self._write([Mark("", submission.student, "track0-seed1", "fault", 0.0, (lost,), "",
                                  did="the program failed")], options.out)
                raise RunError(f"{options.file}: {error}") from error

    def from_values(self, values: dict) -> list[Mark]:
        """Without marks of a program that was graded into this folder before."""
        return [mark for mark in super().from_values(values)
                if mark.student in self.options.found]

    def passed(self, results: Sequence[Mark]) -> bool:
        if any(mark.outcome == NOT_RUN for mark in results):
            raise RunError("the course could not be run: this is no mark")
        return self._has_passed(results)

    def table(self, results: Sequence[Mark]) -> str:
        """Whether it has passed, in a line."""
        if any(mark.outcome == NOT_RUN for mark in results):
            return translated("no mark: the course could not be run")
        had, rules = mean([mark.points for mark in results]), self.options.rules
        had = f"{had:g}" if rules.pass_points - 0.1 < had < rules.pass_points else figure(had)
        most, needed = f"{rules.points.most:g}", f"{rules.pass_points:g}"
        return translated(f"passed with {had} of {most} points, {needed} are needed"
                          if self._has_passed(results) else
                          f"not passed: {had} of {most} points, {needed} are needed")

    def pictures(self, results: Sequence[Mark], out: Path) -> list[str]:
        marks = by_student(results)
        write_student_pages(marks, self.options.rules, out)
        self._write(results, out)
        page = out / STUDENTS / next(iter(marks)) / STUDENT_PAGE
        print(f"the marks: {out / SUMMARY}, {out / JUNIT}; with pictures: {page}", flush=True)
        return []

    def _has_passed(self, results: Sequence[Mark]) -> bool:
        return mean([mark.points for mark in results]) >= self.options.rules.pass_points

    def _write(self, results: Sequence[Mark], out: Path) -> None:
        suite = self._suite(results)
        whole = Xml.Element("testsuites", suite.attrib)
        whole.append(suite)
        Xml.indent(whole)
        write_whole(out / JUNIT, Xml.tostring(whole, "utf-8", xml_declaration=True))
        most = self.options.rules.points.most
        lines = [f"# {_marked_down(results[0].student)}", "", _marked_down(self.table(results)), ""]
        for mark in results:
            had = f"{case_title(mark.case)}{colon()}{headline(mark, most)}"
            rest = [*losses(mark), *filter(None, [translated(mark.note)])]
            lines += [f"- {_marked_down(had)}", *(f"  - {_marked_down(each)}" for each in rest)]
        if self.options.kind is Kind.NONE:
            lines += ["", translated("These submissions ran without a sandbox.")]
        write_whole(out / SUMMARY, "\n".join([*lines, ""]).encode())

    def _suite(self, results: Sequence[Mark]) -> Xml.Element:
        """A test case for each case; if all have passed together, none has failed."""
        rules, fails = self.options.rules, not self._has_passed(results)
        most = rules.points.most
        suite = Xml.Element("testsuite", name=results[0].student, tests=str(len(results)))
        properties = Xml.SubElement(suite, "properties")
        for name, value in (("points", mean([mark.points for mark in results])),
                            ("of", most), ("pass_points", rules.pass_points)):
            Xml.SubElement(properties, "property", name=name, value=f"{value:g}")
        for mark in results:
            case = Xml.SubElement(suite, "testcase", classname=mark.student, name=mark.case)
            said = sentence(mark, most)
            kind = "error" if mark.outcome == NOT_RUN else "failure"
            if kind == "error" or (fails and mark.points < rules.pass_points):
                Xml.SubElement(case, kind, message=headline(mark, most),
                               type=mark.outcome).text = "\n".join(losses(mark))
            Xml.SubElement(case, "system-out").text = said
        for kind in ("failure", "error"):
            suite.set(f"{kind}s", str(len(suite.findall(f"testcase/{kind}"))))
        return suite


def _marked_down(text: str) -> str:
    """The text as Markdown, whatever is in it."""
    return IN_MARKDOWN.sub(r"\\\1", escape(text, quote=False))

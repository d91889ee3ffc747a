"""Reads, counts and shows test results from the reports of pytest and rostest."""

from __future__ import annotations

import contextlib
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

# Messages of pytest and rostest for a test that took too long.
TIMED_OUT = re.compile(r"from pytest-timeout|max time \[[^]]*\] allotted")
SLOWEST = 10
LATE = "left for make test"  # as conftest.py skips


@dataclass
class Result:
    """The result of one file of tests; `output` is shown if any failed."""

    name: str
    seconds: float = 0.0
    passed: int = 0
    skips: list[str] = field(default_factory=list)  # the reason of each skipped test
    failures: list[str] = field(default_factory=list)
    failed_cases: list[str] = field(default_factory=list)  # names of the failures that are tests
    final: bool = False  # a process was left or a time limit reached: no second run
    output: str = ""
    first_failures: list[str] = field(default_factory=list)  # of a run before this one
    first_output: str = ""

    def add_case(self, case: ET.Element) -> None:
        """Count a test case of a report, and its time."""
        self.seconds += float(case.get("time") or 0.0)
        if case.find("failure") is not None or case.find("error") is not None:
            self.failed_cases.append(case.get("name"))
            self.failures.append(f"{self.name}: {case.get('name')}")
            said = "".join(ET.tostring(part, "unicode") for part in case)
            self.final = self.final or bool(TIMED_OUT.search(said))
        elif (skipped := case.find("skipped")) is not None:
            reason = skipped.get("message") or skipped.text or ""
            self.skips.append(" ".join(reason.split()) or "no reason given")
        else:
            self.passed += 1

    def line(self) -> str:
        """Time, count, verdict and name, for the list."""
        verdict = f"{len(self.failures)} FAILED" if self.failures else "ok"
        return f"{self.seconds:7.1f} s  {self.passed:4d} ok  {verdict:9s}  {self.name}"


def pytest_cases(cases: Path) -> dict[str, Result]:
    """A result for each file in the report; none if the report is incomplete."""
    files: dict[str, Result] = {}
    with contextlib.suppress(FileNotFoundError, ET.ParseError):
        for case in ET.parse(cases).iter("testcase"):
            name = case.get("file") or case.get("classname") or case.get("name") or "?"
            files.setdefault(name, Result(name)).add_case(case)
    return files


def note_end(result: Result, code: int, files: Collection[Result], left: list[str]) -> None:
    """Count how pytest itself ended, unless the files' results already show it."""
    failed = any(each.failures for each in files)
    if code == 124:
        result.failures.append(f"{result.name}: not done after {result.seconds:.0f} s")
    elif code not in (0, 1) or not files or (code == 1 and not failed):
        result.failures.append(f"{result.name}: ended with exit code {code}")
    note_left(result, code, left)


def note_left(result: Result, code: int, left: list[str]) -> None:
    """Count processes that a test left running; like a timeout they are final."""
    result.failures += [f"{result.name}: left running: {command}" for command in left]
    result.final = result.final or code == 124 or bool(left)


def rostest_cases(results: Path) -> tuple[list[tuple[bool, ET.Element]], list[str]]:
    """(is rostest's own case, case) of each; its own only tell whether a test node ran at all.

    And the names of files that cannot be read: that of a node that crashed or was killed is empty.
    If it was killed at its time limit rostest's own case says so; of a crash rostest says nothing.
    """
    cases, unreadable = [], []
    for path in sorted(results.rglob("*.xml")):
        try:
            cases += [(path.name.startswith("rostest-"), case)
                      for case in ET.parse(path).iter("testcase")]
        except ET.ParseError:
            unreadable.append(path.name)
    return cases, unreadable


def show_outputs(results: list[Result]) -> None:
    """Print the output of failed files, from the first run and the last."""
    for result in results:
        for title, output in ((f"{result.name}, first run", result.first_output),
                              (result.name, result.output)):
            if output:
                print(f"\n==== {title}")
                print("\n".join(f"  | {line}" for line in output.splitlines()))


def show_slowest(results: list[Result]) -> None:
    """The files that took longest, with seconds."""
    files = sorted((result for result in results if result.seconds and "." in result.name),
                   key=lambda result: -result.seconds)[:SLOWEST]
    print("\nSlowest:")
    print("\n".join(f"{result.seconds:7.1f} s  {result.name}" for result in files))


def show_failed(results: list[Result]) -> None:
    """A line for each failure."""
    failures = [failure for result in results for failure in result.failures]
    if failures:
        print("\nFailed:")
        print("\n".join(f"  {failure}" for failure in failures))


def show_skipped(results: list[Result]) -> None:
    """A line for each reason why tests were skipped, with their number."""
    reasons = Counter(reason for result in results for reason in result.skips)
    if reasons:
        print("\nSkipped:")
        print("\n".join(f"{count:5d}  {reason}" for reason, count in reasons.most_common()))


def show_totals(results: list[Result]) -> bool:
    """Print the last line; returns whether something passed and nothing failed."""
    passed = sum(each.passed for each in results)
    failed, skipped = (sum(len(getattr(each, kind)) for each in results)
                       for kind in ("failures", "skips"))
    last = f"{passed} passed, {failed} failed"
    print(last + (f", {skipped} skipped" if skipped else ""), flush=True)
    return bool(passed) and not failed

"""Runs ruff, pytest and rostest, with a Result of each."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import run_tests_processes as processes
from run_tests_processes import ROOT, run_marked, unseen
from run_tests_results import Result, note_end, note_left, pytest_cases, rostest_cases

OUT = ROOT / "out" / "test"
PROGRESS = re.compile(r"\[ *\d+%\]$")


def run_ruff() -> Result:
    """Check the whole tree; counts as one test."""
    began = time.monotonic()
    done = subprocess.run([shutil.which("ruff") or "ruff", "check", "--output-format=concise"],
                          cwd=ROOT, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    result = Result("ruff check", time.monotonic() - began)
    if done.returncode == 0:
        result.passed = 1
    else:
        result.failures.append("ruff check")
        result.output = done.stdout + done.stderr
    return result


class Progress:
    """Shows pytest's own progress, a line per file, when the line is complete."""

    def __init__(self) -> None:
        self.position = 0

    def __call__(self, log: Path) -> None:
        with log.open("rb") as file:
            file.seek(self.position)
            text = file.read()
        whole = text[: text.rfind(b"\n") + 1]
        self.position += len(whole)
        for line in whole.decode("utf-8", "replace").splitlines():
            if PROGRESS.search(line):
                print(f"  {line}", flush=True)


def run_pytest(limit: float, words: list[str], name: str = "pytest",
               low_priority: bool = False) -> list[Result]:
    """Run the files that pytest finds by these arguments, in one process: a result for each, and
    one for the run itself, called `name`."""
    file = OUT / name.replace(" ", "_")
    cases, log = file.with_suffix(".xml"), file.with_suffix(".log")
    whole = Result(name)
    cases.unlink(missing_ok=True)  # from the previous group
    began = time.monotonic()
    code, left = run_marked([*pytest_command(cases), *words], log, limit, Progress(), low_priority)
    whole.seconds = time.monotonic() - began
    files = pytest_cases(cases)
    note_end(whole, code, files.values(), left)
    if whole.failures or any(result.failures for result in files.values()):
        whole.output = log.read_text(errors="replace")
    for result in files.values():
        print(result.line())
    print(whole.line(), flush=True)
    return [*files.values(), whole]


def pytest_command(cases: Path) -> list[str]:
    """The command of pytest, with results in this file."""
    return [sys.executable, "-m", "pytest", f"--junitxml={cases}", "--color=no", "--tb=short",
            "--continue-on-collection-errors"]


def run_pytest_file(path: Path, limit: float, tests: list[str] | None = None) -> Result:
    """Run one file, or only these tests of it, in a process of its own."""
    name = str(path.relative_to(ROOT))
    result = Result(name)
    if processes.stopping:
        return result
    folder = OUT / name.replace("/", ".")
    folder.mkdir(parents=True)
    cases, log = folder / "pytest.xml", folder / "output.log"
    began = time.monotonic()
    what = [f"{name}::{test}" for test in tests] if tests else [name]
    code, left = run_marked([*pytest_command(cases), *what], log, limit, unseen)
    files = pytest_cases(cases)
    result = files.get(name, result)
    result.seconds = time.monotonic() - began
    note_end(result, code, files.values(), left)
    if result.failures:
        result.output = log.read_text(errors="replace")
    return result


def run_rostest(launch: Path, limit: float) -> Result:
    """Run one launch file; its test nodes have `limit` seconds in total."""
    result = Result(str(launch.relative_to(ROOT)))
    if processes.stopping:
        return result
    folder = OUT / result.name.replace("/", ".")
    folder.mkdir(parents=True)
    log = folder / "output.log"
    began = time.monotonic()
    command = ["rostest", f"--results-base-dir={folder}", str(launch)]
    code, left = run_marked(command, log, limit, unseen)
    inner = 0
    cases, unreadable = rostest_cases(folder)
    for own, case in cases:
        inner += not own
        if not own or case.find("failure") is not None or case.find("error") is not None:
            result.add_case(case)
    if code == 124:
        result.failures.append(f"{result.name}: not done after {limit:.0f} s")
    elif not result.failures and (code or not inner or unreadable):
        result.failures.append(": ".join([
            result.name, f"exit code {code}, {inner} tests ran",
            *(f"{each} cannot be read" for each in unreadable)]))
    note_left(result, code, left)
    result.seconds = time.monotonic() - began
    if result.failures:
        result.output = log.read_text(errors="replace")
    return result

"""Runs ruff, pytest and every rostest file, and ends with one line: N passed, M failed.

Tests that start processes and mostly wait for them run a few files at a time: rostest files, and
the pytest files marked `processes`. Each gets its own session, a free port for its master, and a
time limit. A process that it leaves running is killed and counts as a failure. All other tests are
two pytest runs besides them, at low priority: they use the processors while the others wait. Files
that say `runs alone` measure time: they run last, one after the other.

If only a few files that start processes fail, they run once more, alone (of pytest files, just the
failed tests), because a busy machine may starve them. They are then called unsteady; a hang or a
process left running remains a failure.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import partial
from pathlib import Path

import run_tests_processes as processes
from run_tests_fast import BEGIN_WITHIN, UNTIL, fast_groups
from run_tests_kinds import OUT, run_pytest, run_pytest_file, run_rostest, run_ruff
from run_tests_processes import ROOT
from run_tests_results import (
    LATE,
    Result,
    show_failed,
    show_outputs,
    show_skipped,
    show_slowest,
    show_totals,
)
from run_tests_unsteady import judge_unsteady, read_known

PROCESSES = re.compile(r"^pytestmark = pytest\.mark\.processes\b", re.MULTILINE)
ALONE = re.compile(r"\bruns alone\b")
MOST_SECOND = 6  # more failed files than this are not chance


def run_beside(files: list[Path], jobs: int, limit: float,
               beside: Sequence[Callable[[], list[Result]]] = ()) -> list[Result]:
    """Run files that start processes, `jobs` at a time, and besides them runs of other kinds."""
    results: list[Result] = []
    with ThreadPoolExecutor(jobs) as pool, ThreadPoolExecutor(len(beside) or 1) as others:
        waiting = [others.submit(run) for run in beside]
        waiting += [pool.submit(run_file, file, limit) for file in files]
        for done in as_completed(waiting):
            if processes.stopping:
                pool.shutdown(cancel_futures=True)
                break
            results += done.result()
    return results


def run_file(file: Path, limit: float) -> list[Result]:
    """Run one file that starts processes, and print its line when done."""
    result = (run_rostest if file.suffix == ".test" else run_pytest_file)(file, limit)
    print(result.line(), flush=True)
    return [result]


def run_failed_again(results: list[Result], limit: float) -> list[Result]:
    """The results, with failed files (unless too many) replaced by a second run, alone."""
    if sum(bool(result.failures) for result in results) > MOST_SECOND:
        return results
    return [second_run(result, limit) if may_run_again(result) else result for result in results]


def may_run_again(result: Result) -> bool:
    """Whether it failed, starts processes, and neither hung nor left one of them."""
    file = ROOT / result.name
    return bool(result.failures) and not result.final and file.is_file() and (
        file.suffix == ".test" or bool(PROCESSES.search(file.read_text(encoding="utf-8"))))


def second_run(first: Result, limit: float) -> Result:
    """The file's result when run again; it keeps failures and output of the first run."""
    if processes.stopping:
        return first
    folder = OUT / first.name.replace("/", ".")
    if folder.exists():
        folder.rename(folder.with_name(f"{folder.name}.first"))
    file = ROOT / first.name
    if file.suffix == ".test" or len(first.failed_cases) < len(first.failures):
        second = run_file(file, limit)[0]
    else:
        second = run_pytest_file(file, limit, first.failed_cases)
        second.passed, second.skips = second.passed + first.passed, first.skips + second.skips
        print(second.line(), flush=True)
    second.first_failures, second.first_output = first.failures, first.output
    return second


def files_that_say(pattern: re.Pattern, glob: str) -> list[Path]:
    """Files below src and test whose text has the pattern, sorted by name."""
    found = [*ROOT.glob(f"src/**/test/**/{glob}"), *ROOT.glob(f"test/**/{glob}")]
    return sorted(path for path in found if pattern.search(path.read_text(encoding="utf-8")))


def show_conformance() -> None:
    """Print how much of the interface works and is covered by tests."""
    done = subprocess.run([sys.executable, str(ROOT / "scripts" / "conformance.py")],
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
    print(f"\n==== conformance\n{done.stdout}{done.stderr}")


def run_whole(args: argparse.Namespace, slow: list[Path]) -> list[Result]:
    """Run all tests; `slow` are the pytest files that start processes."""
    rostests = files_that_say(re.compile(""), "*.test")
    alone = [*files_that_say(ALONE, "test_*.py"), *files_that_say(ALONE, "*.test")]
    apart = [f"--ignore={path}" for path in slow]
    halves = {"pytest of the simulator": ["src/sim"],
              "pytest of the rest": ["src", "test", "--ignore=src/sim"]}
    beside = [partial(run_pytest, args.pytest_limit, [*words, *apart], name, low_priority=True)
              for name, words in halves.items()]
    results = run_beside([path for path in [*slow, *rostests] if path not in alone], args.jobs,
                         args.limit, beside)
    return results + run_beside(alone, 1, args.limit)


def run_fast(slow: list[Path]) -> list[Result]:
    """Run a selection that takes 90 s: see run_tests_fast.py."""
    until = time.time() + BEGIN_WITHIN
    os.environ[UNTIL] = str(until)
    results, ran = [], 0
    for group in fast_groups(slow):
        if time.time() < until and not processes.stopping:
            results += run_pytest(2 * BEGIN_WITHIN, [str(path) for path in group])
            ran += len(group)
    every = files_that_say(re.compile(""), "test_*.py") + files_that_say(re.compile(""), "*.test")
    late = sum(result.skips.count(LATE) for result in results)
    print(f"FAST=1 left out {len(every) - ran} of {len(every)} files, with them all that start "
          f"processes, and {late} tests that had not begun after {BEGIN_WITHIN:.0f} s")
    return results


def main() -> int:
    """Run all; 0 if something passed and nothing failed, 130 if interrupted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=3, help="files with processes at a time (3)")
    parser.add_argument("--limit", type=float, default=1200.0, help="seconds for such a file")
    parser.add_argument("--pytest-limit", type=float, default=3000.0, help="seconds for pytest")
    parser.add_argument("--fast", action="store_true", help="what run_tests_fast.py says, in 90 s")
    args = parser.parse_args()
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, processes.stop)
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    results = [run_ruff()]
    print(results[0].line(), flush=True)
    slow = files_that_say(PROCESSES, "test_*.py")  # first: the longest of them take minutes
    results += run_fast(slow) if args.fast else run_whole(args, slow)
    results = run_failed_again(results, args.limit)
    if processes.stopping:
        print("interrupted: nothing of it runs any more", file=sys.stderr)
        return 130
    show_outputs(results)
    if not args.fast:
        show_conformance()
    show_slowest(results)
    if not args.fast:  # which has no file that could be unsteady, and is none of the ten runs
        results.append(Result("unsteady files", failures=judge_unsteady(results, read_known())))
    show_skipped(results)
    show_failed(results)
    return 0 if show_totals(results) else 1


if __name__ == "__main__":
    sys.exit(main())

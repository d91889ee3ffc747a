"""Runs ruff, pytest and every rostest file, and ends with one line: N passed, M failed.

First what is quick, then what starts processes and mostly waits for them: rostest files, and the
pytest files marked `processes`, a few at a time. Each of these gets a session of its own, a free
port for its master and a time limit. What it leaves running is killed and counts as a failure.
Files that say `runs alone` measure time: they come last, one after the other.
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
import uuid
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "test"
MARK = "RUN_TESTS_MARK"  # environment variable by which a test's processes are known
GRACE = 5.0  # s a test's processes have to end after it
STOP = 15.0  # s rostest has to end its nodes when it is told to stop
PROGRESS = re.compile(r"\[ *\d+%\]$")
PROCESSES = re.compile(r"^pytestmark = pytest\.mark\.processes\b", re.MULTILINE)
ALONE = re.compile(r"\bruns alone\b")
Watch = Callable[[Path], None]

stopping = False


@dataclass
class Result:
    """What one file of tests came to; `output` is shown if any failed."""

    name: str
    seconds: float = 0.0
    passed: int = 0
    skipped: int = 0
    failures: list[str] = field(default_factory=list)
    output: str = ""

    def add_case(self, case: ET.Element) -> None:
        self.seconds += float(case.get("time") or 0.0)
        if case.find("failure") is not None or case.find("error") is not None:
            self.failures.append(f"{self.name}: {case.get('name')}")
        elif case.find("skipped") is not None:
            self.skipped += 1
        else:
            self.passed += 1

    def line(self) -> str:
        verdict = f"{len(self.failures)} FAILED" if self.failures else "ok"
        return f"{self.seconds:7.1f} s  {self.passed:4d} ok  {verdict:9s}  {self.name}"


def processes_marked(mark: str) -> list[int]:
    """Process ids whose environment carries the mark, whatever session or parent they have."""
    needle = f"{MARK}={mark}".encode()
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if needle in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
        except OSError:
            continue  # gone by now, or another user's
    return found


def command_line(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode().strip()
    except OSError:
        return f"process {pid}"


def kill_left_over(mark: str, grace: float) -> list[str]:
    """Command lines of what still runs `grace` seconds on; none of it runs afterwards."""
    limit = time.monotonic() + grace
    while (left := processes_marked(mark)) and time.monotonic() < limit:
        time.sleep(0.1)
    commands = [command_line(pid) for pid in left]
    while left:
        for pid in left:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.05)
        left = processes_marked(mark)
    return commands


def run_marked(command: list[str], log: Path, limit: float, watch: Watch) -> tuple[int, list[str]]:
    """Exit code (124 after `limit` seconds), and what was left running; `watch` sees the log."""
    mark = uuid.uuid4().hex
    ros_home = str(log.parent / "ros")  # nothing of a test goes to the person's ~/.ros
    env = dict(os.environ, **{MARK: mark}, ROS_HOME=ros_home, ROS_LOG_DIR=ros_home)
    end = time.monotonic() + limit
    with log.open("wb") as output:
        child = subprocess.Popen(command, cwd=ROOT, env=env, stdin=subprocess.DEVNULL,
                                 stdout=output, stderr=subprocess.STDOUT, start_new_session=True)
        while child.poll() is None and time.monotonic() < end and not stopping:
            time.sleep(0.05)
            watch(log)
        cut_short = child.poll() is None
        if cut_short:
            child.send_signal(signal.SIGINT)
            try:
                child.wait(2.0 if stopping else STOP)
            except subprocess.TimeoutExpired:
                pass
        left = kill_left_over(mark, 0.0 if cut_short else GRACE)
        return (124 if cut_short else child.wait()), left


def unseen(_log: Path) -> None:
    """The watch for a log that nobody waits for."""


class Progress:
    """Shows pytest's own progress, a line a file, as soon as each is whole."""

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


def run_ruff() -> Result:
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


def run_pytest(limit: float, apart: list[Path]) -> list[Result]:
    """All files but those `apart`, in one process; a result for each file, and one for itself."""
    cases, log = OUT / "pytest.xml", OUT / "pytest.log"
    whole = Result("pytest")
    began = time.monotonic()
    code, left = run_marked([*pytest_command(cases), *(f"--ignore={path}" for path in apart)],
                            log, limit, Progress())
    whole.seconds = time.monotonic() - began
    files = pytest_cases(cases)
    failed = any(result.failures for result in files.values())
    note_end(whole, code, failed, left)
    if failed or whole.failures:
        whole.output = log.read_text(errors="replace")
    for result in files.values():
        print(result.line())
    print(whole.line(), flush=True)
    return [*files.values(), whole]


def pytest_command(cases: Path) -> list[str]:
    """What to run, for results in a file of its own."""
    return [sys.executable, "-m", "pytest", f"--junitxml={cases}", "--color=no", "--tb=short",
            "--continue-on-collection-errors"]


def pytest_cases(cases: Path) -> dict[str, Result]:
    """A result for each file that the report names."""
    files: dict[str, Result] = {}
    if cases.exists():
        for case in ET.parse(cases).iter("testcase"):
            name = case.get("file") or case.get("classname") or case.get("name") or "?"
            files.setdefault(name, Result(name)).add_case(case)
    return files


def note_end(result: Result, code: int, failed: bool, left: list[str]) -> None:
    """Count how pytest itself ended, where its cases do not say it already."""
    if code == 124:
        result.failures.append(f"{result.name}: not done after {result.seconds:.0f} s")
    elif code not in (0, 1) or (code == 1 and not failed):
        result.failures.append(f"{result.name}: ended with exit code {code}")
    result.failures += [f"{result.name}: left running: {command}" for command in left]


def run_pytest_file(path: Path, limit: float) -> Result:
    """One file in a process of its own."""
    name = str(path.relative_to(ROOT))
    result = Result(name)
    if stopping:
        return result
    folder = OUT / name.replace("/", ".")
    folder.mkdir(parents=True)
    cases, log = folder / "pytest.xml", folder / "output.log"
    began = time.monotonic()
    code, left = run_marked([*pytest_command(cases), name], log, limit, unseen)
    result = pytest_cases(cases).get(name, result)
    result.seconds = time.monotonic() - began
    note_end(result, code, bool(result.failures), left)
    if result.failures:
        result.output = log.read_text(errors="replace")
    return result


def rostest_cases(results: Path) -> list[tuple[bool, ET.Element]]:
    """(is rostest's own case, case): its own say only whether a test node ran at all."""
    return [(path.name.startswith("rostest-"), case) for path in sorted(results.rglob("*.xml"))
            for case in ET.parse(path).iter("testcase")]


def run_rostest(launch: Path, limit: float) -> Result:
    result = Result(str(launch.relative_to(ROOT)))
    if stopping:
        return result
    folder = OUT / result.name.replace("/", ".")
    folder.mkdir(parents=True)
    log = folder / "output.log"
    began = time.monotonic()
    command = ["rostest", f"--results-base-dir={folder}", str(launch)]
    code, left = run_marked(command, log, limit, unseen)
    inner = 0
    try:
        for own, case in rostest_cases(folder):
            if not own:
                inner += 1
                result.add_case(case)
            elif case.find("failure") is not None or case.find("error") is not None:
                result.add_case(case)
    except ET.ParseError as error:
        result.failures.append(f"{result.name}: unreadable result: {error}")
    if code == 124:
        result.failures.append(f"{result.name}: not done after {limit:.0f} s")
    elif not result.failures and (code or not inner):
        result.failures.append(f"{result.name}: exit code {code}, {inner} tests ran")
    result.failures += [f"{result.name}: left running: {command}" for command in left]
    result.seconds = time.monotonic() - began
    if result.failures:
        result.output = log.read_text(errors="replace")
    return result


def run_apart(files: list[Path], jobs: int, limit: float) -> list[Result]:
    """Files that start processes, so many at a time."""
    results: list[Result] = []
    with ThreadPoolExecutor(jobs) as pool:
        waiting = [pool.submit(run_rostest if file.suffix == ".test" else run_pytest_file,
                               file, limit) for file in files]
        for done in as_completed(waiting):
            if stopping:
                pool.shutdown(cancel_futures=True)
                break
            results.append(done.result())
            print(results[-1].line(), flush=True)
    return results


def files_that_say(pattern: re.Pattern, glob: str) -> list[Path]:
    """Files below src and test whose text has the pattern, in the order of their names."""
    found = [*ROOT.glob(f"src/**/test/**/{glob}"), *ROOT.glob(f"test/**/{glob}")]
    return sorted(path for path in found if pattern.search(path.read_text(encoding="utf-8")))


def report(results: list[Result]) -> int:
    totals: dict[str, int] = defaultdict(int)
    for result in results:
        totals["passed"] += result.passed
        totals["skipped"] += result.skipped
        totals["failed"] += len(result.failures)
    for result in results:
        if result.output:
            print(f"\n==== {result.name}")
            print("\n".join(f"  | {line}" for line in result.output.splitlines()))
    if totals["failed"]:
        print("\nFailed:")
        for result in results:
            print("".join(f"  {failure}\n" for failure in result.failures), end="")
    conformance = subprocess.run([sys.executable, str(ROOT / "scripts" / "conformance.py")],
                                 capture_output=True, text=True, stdin=subprocess.DEVNULL)
    print(f"\n==== conformance\n{conformance.stdout}{conformance.stderr}")
    last = f"{totals['passed']} passed, {totals['failed']} failed"
    print(last + (f", {totals['skipped']} skipped" if totals["skipped"] else ""), flush=True)
    return 0 if totals["passed"] and not totals["failed"] else 1


def stop(_signal: int, _frame: object) -> None:
    global stopping
    stopping = True


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=2, help="files with processes at a time (2)")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds for one of these files")
    parser.add_argument("--pytest-limit", type=float, default=1200.0, help="seconds for pytest")
    args = parser.parse_args()
    for name in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(name, stop)
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    results = [run_ruff()]
    print(results[0].line(), flush=True)
    slow = files_that_say(PROCESSES, "test_*.py")  # first: the longest of them take minutes
    rostests = files_that_say(re.compile(""), "*.test")
    alone = [*files_that_say(ALONE, "*.test")]
    results += run_pytest(args.pytest_limit, slow)
    results += run_apart([*slow, *(path for path in rostests if path not in alone)],
                         args.jobs, args.limit)
    results += run_apart(alone, 1, args.limit)
    if stopping:
        print("interrupted: nothing of it runs any more", file=sys.stderr)
        return 130
    return report(results)


if __name__ == "__main__":
    sys.exit(main())

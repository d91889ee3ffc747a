"""A file of tests in a session of its own, as an item of pytest; nothing of it stays behind.

    python3 -m pytest src/learning_topic/test/lesson_05.test  a rostest file
    python3 -m pytest --own-process FILE...                   Python files, too

Whatever it starts inherits a mark in its environment, and is found by that in any session.
"""

from __future__ import annotations

import contextlib
import os
import re
import resource
import signal
import subprocess
import sys
import time
import uuid
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import psutil
import pytest
from xdist.remote import Producer
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "test"
MARK = "RUN_TESTS_MARK"  # environment variable by which a test's processes are known
LIMIT = 1200.0  # s for a file
GRACE = 5.0  # s that a test's processes have to end after it
STOP = 15.0  # s that rostest has to end its nodes when it took too long
TEST_NODE = re.compile(r"<test\b[^>]*\btype=[\"']([^\"']+\.py)[\"']")
PYTEST = (sys.executable, "-m", "pytest", "--color=no", "--tb=short",
          "--continue-on-collection-errors")

stopping = False  # set by a signal: what runs is cut short, nothing new begins


class Case(NamedTuple):
    """One test case of a report."""

    file: str
    test: str
    outcome: str  # passed, failed or skipped
    text: str  # why
    seconds: float
    problems: tuple[str, ...] = ()  # of a file that runs on its own, besides its tests
    processor: float = 0.0  # s


def rostest_scripts() -> set[Path]:
    """The scripts that a .test file names, wherever they lie below its package's test/."""
    return {found for launch in ROOT.glob("src/**/test/**/*.test")
            for name in TEST_NODE.findall(launch.read_text(encoding="utf-8"))
            for found in launch.parent.rglob(name)}


def processor_seconds() -> float:
    """What this process has used, and what it has waited for: children, theirs, and so on.

    Not in it is what nobody waited for: a process that still runs, or whose parent ended before it.
    """
    used = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(each.ru_utime + each.ru_stime for each in used)


def marked(mark: str) -> list[psutil.Process]:
    """Processes whose mark begins so."""
    return [each for each in psutil.process_iter(["cmdline", "environ"])
            if (each.info["environ"] or {}).get(MARK, "").startswith(mark)]


def kill_left_over(mark: str, grace: float) -> list[str]:
    """Kill processes that still run after `grace` seconds; their commands, and tests of pytest."""
    limit = time.monotonic() + grace
    while (left := marked(mark)) and time.monotonic() < limit:
        time.sleep(0.1)
    names = [", of ".join([" ".join(each.info["cmdline"] or [str(each.pid)]),
                           *filter(None, [each.info["environ"].get("PYTEST_CURRENT_TEST")])])
             for each in left]
    while left:
        for each in left:
            with contextlib.suppress(psutil.NoSuchProcess):
                each.kill()
        time.sleep(0.05)
        left = marked(mark)
    return names


def run_marked(command: Sequence[str], log: Path, limit: float = LIMIT,
               watch: Callable[[Path], None] = lambda log: None) -> tuple[int, list[str]]:
    """Exit code of a command (124 after `limit` seconds), and the processes that it left running.

    `watch` is called with the log, again and again while it runs.
    """
    mark = f"{os.environ.get(MARK, '')}/{uuid.uuid4().hex}"
    ros_home = str(log.parent / "ros")  # tests write nothing to the user's ~/.ros
    env = {name: text for name, text in os.environ.items() if not name.startswith("PYTEST_")}
    env |= {MARK: mark, "ROS_HOME": ros_home, "ROS_LOG_DIR": ros_home}
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
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(2.0 if stopping else STOP)
        left = kill_left_over(mark, 0.0 if cut_short else GRACE)
        return (124 if cut_short else child.wait()), left


def read_cases(folder: Path) -> tuple[list[Case], list[str]]:
    """The cases in reports of pytest or rostest, and the names of reports that cannot be read.

    Of rostest's own cases only failed ones: they tell whether a test node ran at all. The report of
    a node that crashed or was killed is empty. If it was killed at its time limit rostest's own
    case says so; of a crash rostest says nothing.
    """
    cases, unreadable = [], []
    for path in sorted(folder.rglob("*.xml")):
        try:
            found = [_case(each) for each in ET.parse(path).iter("testcase")]
        except ET.ParseError:
            unreadable.append(path.name)
        else:
            own = path.name.startswith("rostest-")
            cases += [each for each in found if not own or each.outcome == "failed"]
    return cases, unreadable


def _case(element: ET.Element) -> Case:
    says = {part.tag: part for part in element}
    outcome = ("failed" if says.keys() & {"failure", "error"} else
               "skipped" if "skipped" in says else "passed")
    name = element.get("name") or "?"
    reason = says["skipped"].get("message") if outcome == "skipped" else None
    told = [(each.get("name"), each.get("value", "")) for each in element.iter("property")]
    return Case(element.get("file") or element.get("classname") or name, name, outcome,
                reason or "\n".join(text for part in element for text in part.itertext()),
                float(element.get("time") or 0.0),
                tuple(value for name, value in told if name == "problem"),
                sum(float(value) for name, value in told if name == "processor"))


def ending(code: int, left: list[str], folder: Path) -> list[str]:
    """What is wrong with how a command ended, unless its reports already show it."""
    cases, unreadable = read_cases(folder)
    failed = any(each.outcome == "failed" for each in cases)
    problems = []
    if code == 124:
        problems.append("not done in time")
    elif code not in (0, 1) or (not failed and (code or not cases or unreadable)):
        problems.append(": ".join([f"exit code {code}, {len(cases)} tests ran",
                                   *(f"{name} cannot be read" for name in unreadable)]))
    return problems + [f"left running: {process}" for process in left]


def folder_of(name: str) -> Path:
    """Where the output of a file of tests lies."""
    return OUT / name.replace("/", ".")


def run_file(path: Path, tests: Sequence[str] = ()) -> list[str]:
    """Run a .test file, or a Python file or only these tests of it; what is wrong besides tests."""
    name = str(path.relative_to(ROOT))
    folder = folder_of(name)
    folder.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".test":
        command = ["rostest", f"--results-base-dir={folder}", str(path)]
    else:
        command = [*PYTEST, f"--junitxml={folder / 'pytest.xml'}",
                   *([f"{name}::{test}" for test in tests] or [name])]
    return ending(*run_marked(command, folder / "output.log"), folder)


class FileItem(pytest.Item):
    """A file that runs on its own."""

    def runtest(self) -> None:
        """Run it; what is wrong besides its tests are properties of the report."""
        problems = run_file(self.path)
        self.user_properties += [("problem", each) for each in problems]
        cases, _ = read_cases(folder_of(str(self.path.relative_to(ROOT))))
        failed = [each.test for each in cases if each.outcome == "failed"]
        if problems or failed:
            pytest.fail("\n".join([*problems, *failed]), pytrace=False)


class FileCollector(pytest.File):
    """Makes the item of a file."""

    def collect(self) -> Iterator[FileItem]:
        """The item, whose time limit is its own."""
        item = FileItem.from_parent(self, name="whole")
        item.add_marker(pytest.mark.timeout(0))
        yield item


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """pytest's hook: notes what the processors have done before a test and its fixtures."""
    item.processor_began = processor_seconds()
    return (yield)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo) -> None:
    """pytest's hook: the last report of a test, of its teardown, has its processor seconds."""
    if call.when == "teardown":
        used = processor_seconds() - item.processor_began
        item.user_properties.append(("processor", f"{used:.2f}"))


def pytest_addoption(parser: pytest.Parser) -> None:
    """pytest's hook."""
    parser.addoption("--own-process", action="store_true", help="each file in a process of its own")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> FileCollector | None:
    """pytest's hook: a .test file that is named on the command line."""
    if file_path.suffix == ".test" and parent.session.isinitpath(file_path):
        return FileCollector.from_parent(parent, path=file_path)
    return None


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> object:
    """pytest's hook: a Python file that runs on its own is not imported here.

    Any other may import what lies beside it.
    """
    if parent.config.getoption("own_process"):
        return FileCollector.from_parent(parent, path=module_path)
    if (beside := str(module_path.parent)) not in sys.path:
        sys.path.insert(0, beside)
    return None


class WholeFiles(LoadFileScheduling):
    """Workers take whole files. Beyond pytest-xdist: a test that crashed does not run again."""

    def remove_node(self, node: WorkerController) -> str | None:
        """Others get what is left of the worker's files; returns the test that it crashed in."""
        left = {test: unit for unit in self.assigned_work.pop(node).values()
                for test, done in unit.items() if not done}
        for crashed, unit in left.items():
            unit[crashed] = True
            self.workqueue.update((self._split_scope(test), unit) for test, unit in left.items()
                                  if not all(unit.values()))
            for other in self.registered_collections.keys() & set(self.nodes):
                self._reschedule(other)
            return crashed
        return None


def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> WholeFiles | None:
    """pytest-xdist's hook."""
    return WholeFiles(config, log) if config.getoption("dist") == "loadfile" else None

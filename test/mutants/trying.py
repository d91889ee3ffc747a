"""Runs tests in a process forked from one that has NumPy, Bullet and Numba loaded."""

from __future__ import annotations

import importlib
import os
import pkgutil
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path
from types import CodeType

import pytest
from changes import NAVIGATION, ROOT, SIMULATOR, Mutant, module_name

OURS = (SIMULATOR.name, NAVIGATION.name)
LEAST, FACTOR = 10.0, 10.0  # a test may take this CPU time: s, plus times the usual
IMPORT = 180.0  # s of CPU time until the first test, including compilation
LONGEST = 3600.0  # s, wall, for one change, on a busy machine
MEMORY = 4 << 30  # bytes in addition to the process's memory at its start


class Changed(MetaPathFinder, SourceFileLoader):
    """Imports a mutant in place of its file, which is not changed."""

    def __init__(self, mutant: Mutant) -> None:
        super().__init__(module_name(mutant.path), str(mutant.path))
        self._source = mutant.source

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """A spec for this module only."""
        return spec_from_file_location(name, self.path, loader=self) if name == self.name else None

    def get_code(self, name: str) -> CodeType:
        """Compile it afresh, never from the cache."""
        return compile(self._source, self.path, "exec", dont_inherit=True)


class Chosen:
    """A pytest plugin: runs these tests in order, with time limits; records failures."""

    def __init__(self, limits: dict[str, float]) -> None:
        self._limits = limits
        self.failed: list[str] = []

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep only the chosen tests."""
        found = {item.nodeid: item for item in items}
        items[:] = [found[name] for name in self._limits if name in found]

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Set a limit at which a signal ends the process."""
        limit = LEAST + FACTOR * self._limits[nodeid]
        _limit(time.process_time() + limit)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Record a failure; the first one suffices."""
        if report.failed:
            self.failed.append(report.nodeid)


def warm_up() -> None:
    """Load all modules that ours import, but not ours."""
    import_all()
    for name in list(sys.modules):
        if name.partition(".")[0] in OURS:
            del sys.modules[name]


def import_all() -> None:
    """Import every module of the core."""
    for name in OURS:
        package = importlib.import_module(name)
        for module in pkgutil.walk_packages(package.__path__, f"{name}."):
            importlib.import_module(module.name)


def outcome(mutant: Mutant, groups: list[dict[str, float]]) -> tuple[str, str]:
    """The result of groups of tests (usual seconds by name) in order, and which test gave it."""
    def work() -> str:
        _limit(IMPORT)
        sys.meta_path.insert(0, Changed(mutant))
        if mutant.package == NAVIGATION.name:
            _compile_changed(mutant)
        for limits in groups:
            tests = Chosen(limits)
            code = run_pytest(["-x", *_files(limits)], tests)
            if code not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
                return f"{code} {(tests.failed or ['while it is imported'])[0]}"
        return "0 "

    code, told = forked(work)
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "timed out", told
    if code:
        return "noticed", f"ends with {code}"
    code, _, test = told.partition(" ")
    return ("unnoticed" if code == "0" else "noticed"), test


def run_pytest(words: Iterable[str], plugin: object) -> int:
    """Returns pytest's exit code."""
    return int(pytest.main(["-q", "--rootdir", str(ROOT), "-p", "no:faulthandler", *words],
                           plugins=[plugin]))


def forked(work: Callable[[], str]) -> tuple[int, str]:
    """Exit code (negative: the signal that ended it) and output of work in a forked process."""
    with tempfile.TemporaryFile() as answer:
        sys.stdout.flush()
        child = os.fork()
        if child == 0:
            _in_child(work, answer.fileno())
        try:
            until = time.monotonic() + LONGEST
            while not (done := os.waitpid(child, os.WNOHANG))[0]:
                if time.monotonic() > until:
                    os.killpg(child, signal.SIGKILL)
                time.sleep(0.01)
        except BaseException:
            os.killpg(child, signal.SIGKILL)
            raise
        try:
            os.killpg(child, signal.SIGKILL)  # processes left by the tests
        except ProcessLookupError:
            pass
        answer.seek(0)
        return os.waitstatus_to_exitcode(done[1]), answer.read().decode()


def _in_child(work: Callable[[], str], answer: int) -> None:
    """Never returns."""
    try:
        os.setsid()
        os.chdir(ROOT)
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):
            os.dup2(nowhere, stream)
        held = int(Path("/proc/self/statm").read_text().split()[5]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_DATA, (held + MEMORY, held + MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.write(answer, work().encode())
        os._exit(0)
    finally:
        os._exit(1)


def _limit(seconds: float) -> None:
    """Limit CPU time, including what this process has already used."""
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, hard))


def _files(tests: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(name.partition("::")[0] for name in tests))


def _compile_changed(mutant: Mutant) -> None:
    """Have Numba neither use cached code that contains the change nor cache any."""
    from numba.core import caching

    from nav_algorithms import compiled

    text = compiled._text
    compiled._text = lambda file: mutant.source if file == mutant.path else text(file)
    caching.IndexDataCacheFile.save = lambda *_: None

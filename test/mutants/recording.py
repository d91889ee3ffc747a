"""Records which tests run which line, once, without any change, until the code changes."""

from __future__ import annotations

import ast
import hashlib
import json
import time
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import coverage
import pytest
from changes import NAVIGATION, ROOT, SIMULATOR, Mutant, module_name
from trying import forked, import_all, run_pytest

from run_session.failure import RunError

FOLDERS = [package.parents[1] for package in (SIMULATOR, NAVIGATION)]
IMPORTED = ""  # in place of a test


class Recorder:
    """A pytest plugin: assigns each executed line to a test, or to a shared fixture's file."""

    def __init__(self) -> None:
        self.coverage = coverage.Coverage(
            data_file=None, config_file=False, include=[f"{folder}/src/*" for folder in FOLDERS])
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []
        self._began = 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Record a test from set-up to tear-down."""
        self.coverage.switch_context(item.nodeid)
        began = time.process_time()
        result = yield
        self.seconds[item.nodeid] = time.process_time() - began
        return result

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: pytest.FixtureDef,
                             request: pytest.FixtureRequest) -> Iterator[None]:
        """A shared fixture is set up for one test but used by others."""
        if fixturedef.scope == "function" or not fixturedef.baseid:
            return (yield)
        self.coverage.switch_context(fixturedef.baseid)
        result = yield
        self.coverage.switch_context(request._pyfuncitem.nodeid)
        return result

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Tests that fail without a change cannot detect one."""
        if report.failed:
            self.failed.append(report.nodeid)


class Recording:
    """The recorded data, and the choice of tests for a mutant."""

    def __init__(self, kept: dict) -> None:
        self.stamp: str = kept["stamp"]
        self.failed: list[str] = kept["failed"]
        self._seconds = {name: seconds for name, seconds in kept["seconds"].items()
                         if name not in self.failed}
        self._lines = {ROOT / path: {int(line): set(self._tests(names))
                                     for line, names in lines.items()}
                       for path, lines in kept["lines"].items()}
        self._imported = {ROOT / path: {int(line) for line, names in lines.items()
                                        if IMPORTED in names}
                          for path, lines in kept["lines"].items()}
        self._reach: dict[str, int] = defaultdict(int)  # test -> lines that it runs
        for lines in self._lines.values():
            for names in lines.values():
                for name in names:
                    self._reach[name] += 1

    def groups(self, mutant: Mutant, first: int = 20) -> list[dict[str, float]]:
        """Tests that may notice it, with their seconds; first a few that are short and run few
        other lines."""
        tree = ast.parse(mutant.path.read_text("utf-8"))
        lines = self._lines.get(mutant.path, {})
        statement = set(_statement(tree, mutant.line))
        names = set().union(*(lines.get(line, ()) for line in statement))
        if _is_compiled(tree, mutant.line):
            names |= self._of_files(_importers(mutant.path, far=True))
        elif statement & self._imported.get(mutant.path, set()):
            names |= self._of_files(_importers(mutant.path, far=False))
        order = sorted(names, key=lambda name: ((self._seconds[name] + 0.01) * self._reach[name],
                                                name))
        groups = [dict.fromkeys(order[:first]), dict.fromkeys(order[first:])]
        return [{name: self._seconds[name] for name in group} for group in groups if group]

    def _tests(self, names: list[str]) -> Iterator[str]:
        for name in names:
            if name in self._seconds:
                yield name
            elif name and "::" not in name:
                yield from (test for test in self._seconds if test.startswith(f"{name}::"))

    def _of_files(self, paths: set[Path]) -> set[str]:
        """Tests that run a line of one of these files, or are in one."""
        within = {str(path.relative_to(ROOT)) for path in paths}
        return {name for path in paths for names in self._lines.get(path, {}).values()
                for name in names} | {
            name for name in self._seconds if name.partition("::")[0] in within}


def recording(file: Path) -> Recording:
    """The recording in the file, or a new one if the code or a test has changed since."""
    stamp = hashlib.sha256(b"".join(
        path.read_bytes() for folder in FOLDERS
        for path in sorted(folder.rglob("*.py")))).hexdigest()
    try:
        kept = json.loads(file.read_text("utf-8"))
    except (OSError, ValueError):
        kept = {}
    if kept.get("stamp") != stamp:
        print("Running all tests of the core once, to see which lines each runs.", flush=True)
        code, told = forked(_record)
        if code or not told:
            raise RunError("the core's tests cannot be run; `make test FAST=1` says why")
        kept = {"stamp": stamp, **json.loads(told)}
        file.write_text(json.dumps(kept), "utf-8")
    return Recording(kept)


def _record() -> str:
    recorder = Recorder()
    recorder.coverage.start()
    recorder.coverage.switch_context(IMPORTED)
    import_all()
    code = run_pytest([f"{folder}/test" for folder in FOLDERS], recorder)
    if code > pytest.ExitCode.TESTS_FAILED:
        return ""  # not all could be imported
    recorder.coverage.stop()
    data = recorder.coverage.get_data()
    lines = {str(Path(path).relative_to(ROOT)): data.contexts_by_lineno(path)
             for path in data.measured_files()}
    return json.dumps({"seconds": recorder.seconds, "failed": recorder.failed, "lines": lines})


def _statement(tree: ast.Module, line: int) -> range:
    """Lines of the statement with this line; of a compound statement, those before its body."""
    found = range(line, line + 1)
    for node in ast.walk(tree):
        if isinstance(node, ast.stmt | ast.ExceptHandler):
            start = min([node.lineno, *(each.lineno for each in
                                        getattr(node, "decorator_list", []))])
            body = getattr(node, "body", None)
            end = body[0].lineno - 1 if body else node.end_lineno
            if start <= line <= max(start, end):
                found = range(start, max(start, end) + 1)
    return found


def _is_compiled(tree: ast.Module, line: int) -> bool:
    """Whether the line is in a function compiled by Numba, which no trace shows."""
    return any(isinstance(node, ast.FunctionDef) and node.lineno <= line <= node.end_lineno
               and any("compiled" in ast.unparse(each) for each in node.decorator_list)
               for node in ast.walk(tree))


def _importers(path: Path, far: bool) -> set[Path]:
    """The file and its importers in core and tests; `far`: and their importers, too."""
    found, new = {path}, {path}
    while new:
        names = {module_name(each) for each in new}
        new = {file for file, imported in _imports().items() if imported & names} - found
        found |= new
        if not far:
            break
    return found


@cache
def _imports() -> dict[Path, set[str]]:
    """File -> modules that it imports, or imports from."""
    found = defaultdict(set)
    for folder in FOLDERS:
        for path in [*folder.glob("src/**/*.py"), *folder.glob("test/*.py")]:
            for node in ast.walk(ast.parse(path.read_text("utf-8"))):
                if isinstance(node, ast.Import):
                    found[path] |= {each.name for each in node.names}
                elif isinstance(node, ast.ImportFrom):
                    found[path] |= {node.module, *(f"{node.module}.{each.name}"
                                                   for each in node.names)}
    return found

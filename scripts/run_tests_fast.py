"""Chooses the tests for `make test FAST=1`: for what has changed since main, without processes.

First those that check all of the code and the changed test files, then the others of each package
with changes (for files in no package: those of test/), then the core's. Each group is one run of
pytest, since collecting all tests would take too long.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path

from run_tests_processes import ROOT

ALWAYS = ("test_arrows.py", "test_docstrings.py")  # in test/
CORE = ("src/sim/bullet_sim/test", "src/navigation/nav_algorithms/test")
MAIN = ("origin/main", "main")
BEGIN_WITHIN = 60.0  # s; tests that have not begun by then are skipped, as conftest.py says
UNTIL = "TESTS_BEGIN_UNTIL"  # environment variable: s since 1970


def fast_groups(apart: Iterable[Path]) -> list[list[Path]]:
    """The test files in order, grouped by run of pytest, without those in `apart`."""
    return choose(changed_files(), set(apart))


def choose(changed: list[Path], apart: set[Path]) -> list[list[Path]]:
    """The same for these changed files."""
    homes = [*sorted({_home(path) for path in changed}), *(ROOT / name for name in CORE)]
    tests = {home: sorted({*home.rglob("test_*.py")} - apart) for home in homes}
    first = [ROOT / "test" / name for name in ALWAYS]
    first += [path for path in changed if path in tests[_home(path)] and path not in first]
    groups = [first, *([path for path in files if path not in first] for files in tests.values())]
    return [group for group in groups if group]


def changed_files() -> list[Path]:
    """Files that differ from where this branch left main, and untracked ones."""
    base = next(filter(None, (_git("merge-base", "HEAD", name) for name in MAIN)), "HEAD\n").strip()
    names = _git("diff", "--name-only", base) + _git("ls-files", "--others", "--exclude-standard")
    return [ROOT / name for name in names.splitlines()]


def _home(path: Path) -> Path:
    """The folder of a file's tests: its package's, or the repository's own."""
    package = next((folder for folder in path.parents if (folder / "package.xml").exists()), ROOT)
    return package / "test"


def _git(*words: str) -> str:
    """git's output; empty if it fails, as in an unpacked archive."""
    done = subprocess.run(["git", *words], cwd=ROOT, text=True, capture_output=True)
    return done.stdout if done.returncode == 0 else ""

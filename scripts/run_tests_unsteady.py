"""Unsteady tests, which failed besides others but passed alone: known ones, and limits."""

from __future__ import annotations

import contextlib
import json
import os
from pathlib import Path

import yaml
from run_tests_processes import ROOT
from run_tests_results import Result

KNOWN = ROOT / "test" / "unsteady.yaml"
MOST_NEW = 3  # in one run; more are not chance
RUNS = 10  # of this user, in which an unknown file may be unsteady once
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"))
HISTORY = CACHE / "ros1-driving-courses" / "unsteady.json"  # lists of files, a list a run


def read_known(path: Path = KNOWN) -> list[dict]:
    """The list: `file`, if not all of it `test`, `reason` and `date` of each."""
    return yaml.safe_load(path.read_text(encoding="utf-8")) or []


def is_known(result: Result, known: list[dict]) -> bool:
    """Whether each test that failed in the first run is in the list."""
    return all(any(failure == f"{each['file']}: {each['test']}" if "test" in each
                   else result.name == each["file"] for each in known)
               for failure in result.first_failures)


def remember(new: list[str], history: Path = HISTORY) -> list[str]:
    """Add this run's files to the history; returns those that were unsteady in it before."""
    before: list[list[str]] = []
    with contextlib.suppress(OSError, ValueError, TypeError, KeyError):  # or its content is invalid
        before = [list(map(str, run)) for run in json.loads(history.read_text("utf-8"))[1 - RUNS:]]
    with contextlib.suppress(OSError):  # a home that is full or cannot be written
        history.parent.mkdir(parents=True, exist_ok=True)
        history.write_text(json.dumps([*before, new]) + "\n", encoding="utf-8")
    return [name for name in new if any(name in run for run in before)]


def judge_unsteady(results: list[Result], known: list[dict], history: Path = HISTORY) -> list[str]:
    """Show the unsteady files; returns failures for new ones that are too many or repeated."""
    unsteady = [result for result in results if result.first_failures and not result.failures]
    new = [result.name for result in unsteady if not is_known(result, known)]
    again = [f"{name}: unsteady twice in {RUNS} runs" for name in remember(new, history)]
    if not unsteady:
        return []
    print("\nFailed beside others, passed alone:")
    for result in unsteady:
        print("\n".join(f"  {failure}" for failure in result.first_failures))
    for name in new:
        print(f"UNSTEADY: {name}: mend it, or name it in test/unsteady.yaml with reason and date")
    print(f"{len(unsteady)} unsteady: {' '.join(result.name for result in unsteady)}")
    if len(new) <= MOST_NEW:
        return again
    return [f"{len(new)} unsteady files that test/unsteady.yaml does not name; at most {MOST_NEW}",
            *again]

"""Tests that failed beside others and passed alone: which are known, and how many may be new."""

from __future__ import annotations

from pathlib import Path

import yaml
from run_tests_processes import ROOT
from run_tests_results import Result

KNOWN = ROOT / "test" / "unsteady.yaml"
MOST_NEW = 3  # in one run; more are no accident


def read_known(path: Path = KNOWN) -> list[dict]:
    """The list: `file`, if not all of it `test`, `reason` and `date` of each."""
    return yaml.safe_load(path.read_text(encoding="utf-8")) or []


def is_known(result: Result, known: list[dict]) -> bool:
    """Whether each test that failed at first is in the list."""
    return all(any(failure == f"{each['file']}: {each['test']}" if "test" in each
                   else result.name == each["file"] for each in known)
               for failure in result.first_failures)


def judge_unsteady(results: list[Result], known: list[dict]) -> list[str]:
    """Show the unsteady files; returns the failures that too many new ones are."""
    unsteady = [result for result in results if result.first_failures and not result.failures]
    if not unsteady:
        return []
    print("\nFailed beside others, passed alone:")
    for result in unsteady:
        print("\n".join(f"  {failure}" for failure in result.first_failures))
    new = [result.name for result in unsteady if not is_known(result, known)]
    for name in new:
        print(f"UNSTEADY: {name}: mend it, or name it in test/unsteady.yaml with reason and date")
    print(f"{len(unsteady)} unsteady: {' '.join(result.name for result in unsteady)}")
    if len(new) <= MOST_NEW:
        return []
    return [f"{len(new)} unsteady files that test/unsteady.yaml does not name; at most {MOST_NEW}"]

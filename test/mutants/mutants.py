#!/usr/bin/env python3
"""Mutation testing: makes small changes to the core's code, and counts those that tests notice.

    mutants.py [--sample N] [--seed N]

If restarted, it resumes, and retries mutants that were not noticed if the tests have changed since.
Unnoticed mutants are in out/mutants/unnoticed.diff. Exit code 0: at least 85 % are noticed; 1:
fewer; 2: could not run.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import json
import sys
from collections import Counter
from itertools import islice
from pathlib import Path

from changes import PACKAGES, ROOT, Equal, Mutant, drawn
from recording import Recording, recording
from trying import outcome, warm_up

from evaluation.command_line import LARGEST_SEED, Parser, run_program

OUT = ROOT / "out" / "mutants"
GOAL = 0.85  # of those that are not equal
OUTCOMES = ("noticed", "timed out", "unnoticed", "equal")


def main(words: list[str] | None = None) -> int:
    """The exit code."""
    options = _options(words)
    OUT.mkdir(parents=True, exist_ok=True)
    warm_up()
    recorded = recording(OUT / "lines.json")
    for test in recorded.failed:
        print(f"{test} fails without a change: it counts for nothing", flush=True)
    equal, kept = Equal(), Kept(OUT / "results.jsonl")
    results: list[tuple[Mutant, str]] = []
    with contextlib.suppress(KeyboardInterrupt):
        for mutant in islice(drawn(options.seed), options.sample):
            known = "equal" if equal.why(mutant) else kept.known(mutant, recorded.stamp)
            results.append((mutant, known or _try(mutant, len(results) + 1, recorded, kept)))
    (OUT / "unnoticed.diff").write_text("".join(
        difference(mutant) for mutant, result in results if result == "unnoticed"), "utf-8")
    return int(report(results) < GOAL)


def _try(mutant: Mutant, number: int, recorded: Recording, kept: Kept) -> str:
    result, by = outcome(mutant, recorded.groups(mutant))
    kept.add(mutant, recorded.stamp, result, by)
    print(f"{number:5} {result:9} {mutant.place} {mutant.operator} {by}", flush=True)
    return result


class Kept:
    """results.jsonl: the result of each mutant so far."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._rows = {}
        if path.exists():
            for line in path.read_text("utf-8").splitlines():
                with contextlib.suppress(ValueError):  # an incomplete line: the program was killed
                    row = json.loads(line)
                    self._rows[row["key"]] = row

    def known(self, mutant: Mutant, stamp: str) -> str | None:
        """The known result; None if it is to be tried. `stamp` identifies the tests."""
        row = self._rows.get(mutant.key)
        fresh = row and (row["result"] != "unnoticed" or row["stamp"] == stamp)
        return row["result"] if fresh else None

    def add(self, mutant: Mutant, stamp: str, result: str, by: str) -> None:
        """Append a result immediately, so that nothing is lost."""
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"key": mutant.key, "place": mutant.place, "result": result,
                                   "by": by, "change": mutant.lines, "stamp": stamp}) + "\n")


def difference(mutant: Mutant) -> str:
    """The mutant as `diff -u` would show it, below its place."""
    before = mutant.path.read_text("utf-8").splitlines(keepends=True)
    return f"{mutant.place}\n" + "".join(islice(difflib.unified_diff(
        before, mutant.source.splitlines(keepends=True), n=2), 2, None)) + "\n"


def report(results: list[tuple[Mutant, str]]) -> float:
    """Print the table; returns the noticed share of the mutants that are not equal."""
    counts = Counter((mutant.package, result) for mutant, result in results)
    print(f"{'package':15} {'mutants':>7} " + " ".join(f"{name:>9}" for name in OUTCOMES)
          + "  noticed of those not equal")
    part = 0.0
    for title, packages in (*((name, [name]) for name in PACKAGES), ("all", list(PACKAGES))):
        numbers = [sum(counts[package, name] for package in packages) for name in OUTCOMES]
        noticed, late, unnoticed, _ = numbers
        part = (noticed + late) / max(1, noticed + late + unnoticed)
        print(f"{title:15} {sum(numbers):7} " + " ".join(f"{number:9}" for number in numbers)
              + f"  {part:.1%}")
    return part


def _options(words: list[str] | None) -> argparse.Namespace:
    parser = Parser("", prog="mutants.sh", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_whole("--sample", 1000, "mutants", least=1)
    parser.add_whole("--seed", 1, "of the sample", most=LARGEST_SEED)
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(run_program("mutants", main))

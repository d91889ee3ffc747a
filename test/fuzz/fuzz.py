#!/usr/bin/env python3
"""Gives spoilt input to what takes it from strangers, and says what came of it.

    fuzz.py [--minutes M] [--target NAME] [--seed N]
    fuzz.py --target NAME --input FILE     one input once more

Exit code 0: nothing found; 1: something, kept in out/fuzz/; 2: could not run.
"""

from __future__ import annotations

import argparse
import math
import sys
import tempfile
import time
from pathlib import Path

from campaign import Report, replay, run
from target import ROOT
from targets import TARGETS

OUT = ROOT / "out" / "fuzz"
USUAL = 10.0  # minutes
EXAMPLES = 50  # of a target before it is the next one's turn


def main(words: list[str] | None = None) -> int:
    """The exit code."""
    options = _parser().parse_args(words)
    if options.input:
        return _replay(options)
    try:
        OUT.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=OUT).close()
    except OSError as error:
        return _wrong(f"nothing can be kept in {OUT}: {error.strerror}")
    chosen = [TARGETS[options.target]] if options.target else list(TARGETS.values())
    reports = {target.name: Report(target, OUT) for target in chosen}
    until, seed = time.monotonic() + options.minutes * 60, options.seed
    try:
        while time.monotonic() < until:
            for target in chosen:
                run(reports[target.name], seed, EXAMPLES)
                if time.monotonic() > until:
                    break
            seed += 1
    except KeyboardInterrupt:
        pass
    finally:
        for report in reports.values():
            report.close()
    print(f"{'target':12} {'inputs':>8} {'inputs/s':>9} {'findings':>9}")
    for report in reports.values():
        print(report.row())
    return int(any(report.findings for report in reports.values()))


def _replay(options: argparse.Namespace) -> int:
    if not options.target:
        return _wrong("INPUT= needs the TARGET= that reads it")
    try:
        content = options.input.read_bytes()
    except OSError as error:
        return _wrong(f"{options.input} cannot be read: {error.strerror}")
    fault = replay(TARGETS[options.target], content)
    print(f"{options.target}: {fault or 'nothing is wrong'}")
    return int(fault is not None)


def _wrong(text: str) -> int:
    print(f"fuzz: {text}", file=sys.stderr)
    return 2


class _Parser(argparse.ArgumentParser):
    """One line for a mistake."""

    def error(self, message: str) -> None:
        sys.exit(_wrong(message))


def _minutes(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value <= 100_000:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of minutes above 0")
    return value


def _target(text: str) -> str:
    if text not in TARGETS:
        raise argparse.ArgumentTypeError(f"no target {text!r}; there are: {', '.join(TARGETS)}")
    return text


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="fuzz", description=__doc__,
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=_minutes, default=USUAL)
    parser.add_argument("--target", type=_target)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--input", type=Path)
    return parser


if __name__ == "__main__":
    sys.exit(main())

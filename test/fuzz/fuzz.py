#!/usr/bin/env python3
"""Gives spoilt input to what takes it from strangers, and says what came of it.

    fuzz.py [--minutes M] [--target NAME] [--seed N]
    fuzz.py --target NAME --input FILE     one input once more

Exit code 0: nothing found; 1: something, kept in out/fuzz/; 2: could not run.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

from campaign import Report, replay, run
from target import ROOT
from targets import TARGETS

from evaluation.command_line import LARGEST_SEED, Parser, number, one_of, run_program
from run_session.failure import RunError

OUT = ROOT / "out" / "fuzz"
EXAMPLES = 50  # of a target before it is the next one's turn


def main(words: list[str] | None = None) -> int:
    """The exit code."""
    options = _options(words)
    if options.input:
        return _replay(options)
    try:
        OUT.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=OUT).close()
    except OSError as error:
        raise RunError(f"nothing can be kept in {OUT}: {error.strerror}") from error
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
        raise RunError("INPUT= needs the TARGET= that reads it")
    try:
        content = options.input.read_bytes()
    except OSError as error:
        raise RunError(f"{options.input} cannot be read: {error.strerror}") from error
    fault = replay(TARGETS[options.target], content)
    print(f"{options.target}: {fault or 'nothing is wrong'}")
    return int(fault is not None)


def _options(words: list[str] | None) -> argparse.Namespace:
    parser = Parser("", prog="fuzz.sh", description=__doc__,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", default=10.0, metavar="M", help="(10)", type=partial(
        number, "--minutes (MINUTES=)", least=0.001, most=100_000.0, what="a number of minutes"))
    parser.add_argument("--target", help="one of them alone",
                        type=partial(one_of, "target", "TARGET", TARGETS))
    parser.add_whole("--seed", int(time.time()) % LARGEST_SEED, "of the first inputs",
                     most=LARGEST_SEED)
    parser.add_argument("--input", type=Path, help="a file to give to the target once more")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(run_program("fuzz", main))

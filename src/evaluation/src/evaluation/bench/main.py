"""The benchmark from beginning to end: measure part by part, print, write, draw."""

from __future__ import annotations

import datetime
import importlib
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

from evaluation.bench import machine
from evaluation.bench.acceptance import judge
from evaluation.bench.options import Options, parse_options
from evaluation.bench.results import (
    PartResult,
    Results,
    acceptance_table,
    figure_table,
    write_json,
)
from evaluation.bench.settings import Settings
from evaluation.course_run.failure import RunError
from evaluation.course_run.interruption import interruptible

MEASURED, NOT_MEASURED, INTERRUPTED = 0, 2, 130


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    try:
        with interruptible():
            return _run(parse_options(arguments))
    except RunError as failure:
        _complain(failure)
        return NOT_MEASURED
    except KeyboardInterrupt:
        print("bench: interrupted; all processes ended", file=sys.stderr)
        return INTERRUPTED


def _run(options: Options) -> int:
    write_chart = _chart_writer()  # missing packages are said before anything is measured
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error
    if not os.access(options.out, os.W_OK):
        raise RunError(f"--out {options.out}: it cannot be written to")
    settings = Settings(options.quick, options.memory_s, options.out, _say)
    began = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
    results = Results(began, options.quick, machine.describe())
    for part in options.parts:
        _say(f"--- {part}")
        results.parts.append(_measure(part, settings))
        print(figure_table(results.parts[-1]), flush=True)
        write_json(results, options.out / "bench.json")  # an interrupted run keeps what it has
    verdicts = judge(results.figures())
    if verdicts:
        print(acceptance_table(verdicts))
    write_chart(results, options.out / "bench.png")
    _say(f"written: {options.out / 'bench.json'}, {options.out / 'bench.png'}")
    return NOT_MEASURED if any(part.failure for part in results.parts) else MEASURED


def _chart_writer() -> Callable[[Results, Path], None]:
    try:
        return importlib.import_module("evaluation.bench.chart").write_chart
    except ImportError as error:
        raise RunError(f"{error.name} is not installed: scripts/setup.sh --bench") from error


def _measure(part: str, settings: Settings) -> PartResult:
    """One part; its failure does not keep the others from being measured."""
    module = importlib.import_module(f"evaluation.bench.parts.{part}")
    began, others = time.monotonic(), machine.Others()
    try:
        figures, failure = tuple(module.measure(settings)), ""
    except RunError as error:
        _complain(error, f"part {part}: ")
        figures, failure = (), str(error)
    return PartResult(part, figures, time.monotonic() - began, others.percent(), failure)


def _say(text: str) -> None:
    print(text, flush=True)


def _complain(failure: RunError, where: str = "") -> None:
    if failure.details:
        print(failure.details, file=sys.stderr)
    print(f"bench: {where}{failure}", file=sys.stderr)

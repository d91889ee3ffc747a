"""The benchmark from beginning to end: measure part by part, print, write, draw."""

from __future__ import annotations

import datetime
import importlib
import os
import time

from evaluation.command_line import NOT_RUN, PASSED, complain, run_program
from run_session.failure import RunError
from sim_bench import machine
from sim_bench.acceptance import judge
from sim_bench.chart import write_chart
from sim_bench.options import Options, parse_options
from sim_bench.results import (
    PartResult,
    Results,
    acceptance_table,
    figure_table,
    write_json,
)
from sim_bench.settings import Settings


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("bench", lambda: _run(parse_options(arguments)))


def _run(options: Options) -> int:
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
    return NOT_RUN if any(part.failure for part in results.parts) else PASSED


def _measure(part: str, settings: Settings) -> PartResult:
    """One part; its failure does not keep the others from being measured."""
    module = importlib.import_module(f"sim_bench.parts.{part}")
    began, others = time.monotonic(), machine.Others()
    try:
        figures, failure = tuple(module.measure(settings)), ""
    except RunError as error:
        complain(f"bench: part {part}", error)
        figures, failure = (), str(error)
    return PartResult(part, figures, time.monotonic() - began, others.percent(), failure)


def _say(text: str) -> None:
    print(text, flush=True)

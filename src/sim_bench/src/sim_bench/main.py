"""The benchmark from beginning to end: measure part by part, print, write, draw."""

from __future__ import annotations

import datetime
import importlib
import os
import platform
import time
from pathlib import Path

import psutil

from evaluation.command_line import NOT_RUN, PASSED, complain, run_program
from run_session.failure import RunError
from run_session.processes import processes
from run_session.session import versions
from sim_bench.results import (
    PartResult,
    Results,
    acceptance_table,
    figure_table,
    write_chart,
    write_json,
)
from sim_bench.settings import Settings, parse, say


def main(arguments: list[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program("bench", lambda: _run(parse(arguments)))


def _run(settings: Settings) -> int:
    settings.out.mkdir(parents=True, exist_ok=True)
    began = datetime.datetime.now().astimezone().isoformat(timespec="seconds")
    results, file = Results(began, settings.quick, _machine()), settings.out / "bench.json"
    write_json(results, file)
    for part in settings.parts:
        say(f"--- {part}")
        results.parts.append(_measure(part, settings))
        say(figure_table(results.parts[-1]))
        write_json(results, file)  # an interrupted run keeps what it has
    if verdicts := results.verdicts():
        say(acceptance_table(verdicts))
    write_chart(results, settings.out / "bench.png")
    say(f"written: {file}, {settings.out / 'bench.png'}")
    return NOT_RUN if any(part.failure for part in results.parts) else PASSED


def _measure(part: str, settings: Settings) -> PartResult:
    """One part; its failure does not keep the others from being measured."""
    module = importlib.import_module(f"sim_bench.parts.{part}")
    began, others = time.monotonic(), _used_by_others()
    try:
        figures, failure = tuple(module.measure(settings)), ""
    except RunError as error:
        complain(f"bench: part {part}", error)
        figures, failure = (), str(error)
    took = time.monotonic() - began
    percent = max(0.0, 100 * (_used_by_others() - others) / took)
    return PartResult(part, figures, took, percent, failure)


def _machine() -> dict:
    """Processor, cores, memory and versions, for bench.json."""
    said = Path("/proc/cpuinfo").read_text(encoding="utf-8").partition("model name")[2]
    return {
        "processor": said.partition("\n")[0].lstrip("\t: ") or platform.machine(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_gb": round(psutil.virtual_memory().total / 1e9, 1),
        "kernel": platform.release(),
        "versions": versions(Path(__file__).parent, ()),
    }


def _used_by_others() -> float:
    """Processor time (s, of all cores) of what is neither this process nor started by it."""
    all_, ours = psutil.cpu_times(), os.times()
    return (all_.user + all_.nice + all_.system + all_.irq + all_.softirq
            - sum(ours[:4]) - sum(process.cpu for process in processes()))

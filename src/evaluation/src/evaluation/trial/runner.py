"""Tries case by case: resumes, prints, writes report.json and report.html, gives the exit code."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from evaluation.session.failure import RunError
from evaluation.session.session import Session
from evaluation.trial.program import NOT_PASSED, PASSED, run_program
from evaluation.trial.protocol import REPORT, Case, Trial
from evaluation.trial.report import write_json, write_page


def run_trial(trial: Trial, arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program(trial.program, lambda: _run(trial, trial.parse(arguments)))


def _run(trial: Trial, options: argparse.Namespace) -> int:
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error
    results = trial.earlier(options) if options.resume else []
    cases = trial.cases(options)
    try:
        _try_all(trial, cases, results, options.out)
    finally:
        if results:  # what was tried is kept, however it ended
            _show(trial, results, options.out)
    return PASSED if trial.passed(results) else NOT_PASSED


def _try_all(trial: Trial, cases: Sequence[Case], results: list[Any], out: Path) -> None:
    there = {result.name for result in results}
    with Session(out) as session:
        for number, case in enumerate(cases, start=1):
            if case.name in there or not trial.is_needed(case, results):
                continue
            results.append(try_case(trial, session, case))
            count = "" if trial.open_ended else f"[{number}/{len(cases)}] "
            session.progress.say(f"{count}{trial.line(results[-1])}")
            write_json(trial.values(results), out / REPORT)


def try_case(trial: Trial, session: Session, case: Case) -> Any:
    """The result of one case."""
    trial.setup(session, case)
    return trial.score(trial.run())


def _show(trial: Trial, results: list[Any], out: Path) -> None:
    table = trial.table(results)
    print(table, flush=True)
    write_json(trial.values(results), out / REPORT)
    pictures = trial.pictures(results, out)
    page = write_page(out, trial.program, table, [trial.line(each) for each in results], pictures)
    print(f"written to {out}: {', '.join((REPORT, page, *pictures))}", flush=True)

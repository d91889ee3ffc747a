"""Runs case by case: resumes, prints, writes report.json and report.html, returns the exit code."""

from __future__ import annotations

import argparse
import contextlib
import importlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from evaluation.trial.program import NOT_PASSED, PASSED, complain, run_program
from evaluation.trial.protocol import REPORT, Case, Trial, try_case
from evaluation.trial.report import write_json, write_page
from run_session.failure import RunError
from run_session.files import check_space
from run_session.master_choice import own_port
from run_session.session import Session
from run_session.status_line import StatusLine


def run_trial(trial: Trial, arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit code."""
    return run_program(trial.program, lambda: _run(trial, trial.parse(arguments), arguments))


def _run(trial: Trial, options: argparse.Namespace, arguments: Sequence[str]) -> int:
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunError(f"--out {options.out}: {error.strerror}") from error
    check_space(options.out)
    _, why_not_callers = own_port()
    if why_not_callers:
        print(why_not_callers[0] % why_not_callers[1:], flush=True)
    tally = Tally(trial, options)
    try:
        if options.workers > 1 or options.scheduler:
            _try_elsewhere(tally, trial, options, arguments)
        else:
            _try_here(tally, trial, options.out)
    finally:
        if tally.results:  # finished cases are kept, however the run ended
            _show(trial, tally, options.out)
    if tally.failures:
        raise RunError(f"{len(tally.failures)} of {len(tally.cases)} cases could not be run; "
                       "--resume tries them again")
    return PASSED if trial.passed(tally.results) else NOT_PASSED


class Tally:
    """The results so far, in the order of the cases; those of no current case come first."""

    def __init__(self, trial: Trial, options: argparse.Namespace):
        self._trial, self._options = trial, options
        self.results = trial.earlier(options) if options.resume else []
        self.cases = trial.cases(options)
        self.failures: list[str] = []  # a line each
        self._place = {case.name: number for number, case in enumerate(self.cases)}

    def is_needed(self, case: Case) -> bool:
        """Whether a case still has to be run, given the results of those before it."""
        there = {result.name for result in self.results}
        before = [each for each in self.results if self._number(each) < self._place[case.name]]
        return case.name not in there and self._trial.is_needed(case, before)

    def take(self, result: Any, say: Callable[[str], None]) -> None:
        """Add a result, print its line and write the report."""
        self.results.append(result)
        self.results.sort(key=self._number)
        count = sum(self._number(each) >= 0 for each in self.results)
        shown = "" if self._trial.open_ended else f"[{count}/{len(self.cases)}] "
        say(f"{shown}{self._trial.line(result)}")
        self.write()

    def write(self) -> None:
        """Write the report so far, with the options that --resume requires to be the same."""
        write_json({**self._trial.values(self.results), "options": self._options.shared},
                   self._options.out / REPORT)

    def drop_unneeded(self) -> None:
        """Drop results of cases that a sequential run would not have run."""
        kept = [each for each in self.results if self._number(each) < 0]
        for each in self.results[len(kept):]:
            if self._trial.is_needed(self.cases[self._number(each)], kept):
                kept.append(each)
        self.results[:] = kept

    def _number(self, result: Any) -> int:
        return self._place.get(result.name, -1)


def _try_here(tally: Tally, trial: Trial, out: Path) -> None:
    with Session(out) as session:
        for case in tally.cases:
            if tally.is_needed(case):
                tally.take(try_case(trial, session, case), session.progress.say)


def _try_elsewhere(tally: Tally, trial: Trial, options: argparse.Namespace,
                   arguments: Sequence[str]) -> None:
    try:
        workers = importlib.import_module("evaluation.trial.workers")
    except ImportError as error:
        raise RunError(f"{error.name} is not installed: scripts/setup.sh --workers") from error
    needed = [case for case in tally.cases if tally.is_needed(case)]
    say = StatusLine().say
    with contextlib.closing(workers.try_on_workers(
            trial, needed, options, arguments, tally.is_needed, say)) as tried:
        for case, result in tried:
            if isinstance(result, RunError):
                tally.failures.append(f"{case.name}: could not be run: {result}")
                complain(trial.program, RunError(tally.failures[-1], result.details))
            else:
                tally.take(result, say)
    tally.drop_unneeded()


def _show(trial: Trial, tally: Tally, out: Path) -> None:
    table = trial.table(tally.results)
    print(table, flush=True)
    tally.write()
    pictures = trial.pictures(tally.results, out)
    lines = [*(trial.line(each) for each in tally.results), *tally.failures]
    page = write_page(out, trial.program, table, lines, pictures)
    print(f"written to {out}: {', '.join((REPORT, page, *pictures))}", flush=True)

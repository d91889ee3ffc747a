"""A trial: its cases, how one is set up, run and scored; and the runner of them all."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from types import UnionType
from typing import Any, ClassVar, get_args, get_origin, get_type_hints

from node_basics.ending import drop_unread_output

from evaluation.command_line import (
    NOT_PASSED,
    PASSED,
    Parser,
    complain,
    option_of,
    results_folder,
    run_program,
)
from evaluation.report import write_json, write_page
from run_session.failure import RunError
from run_session.files import check_space
from run_session.master import own_port
from run_session.session import Session, StatusLine

REPORT = "report.json"
MOST_WORKERS = 1000


@dataclass(frozen=True)
class Case:
    """One case: picklable; run twice, it gives the same files and the same result."""

    name: str  # unique among the cases; also that of its result
    set: str = ""  # those of a set are summed up together
    seed: int = 0
    driver: str = ""  # the program that drives, where trials differ in that
    repeat: int = 0  # number among the cases that are alike but for this


class Trial(ABC):
    """Cases that are driven and judged one by one; the runner does everything else.

    A result is an object with the `name` of its case. Besides its options a trial keeps nothing:
    what one step finds, the next is given. So another process may run another case: it makes a
    trial of its own from the same arguments (`parse`) and is given the case.
    """

    options: argparse.Namespace  # as `parse` returned them

    package: ClassVar[str] = "evaluation"  # which contains the program
    program: ClassVar[str]
    does: ClassVar[str]  # for --help
    good: ClassVar[str]  # what exit code 0 means
    writes: ClassVar[str]  # the contents of the folder for results
    open_ended: ClassVar[bool] = False  # whether the results decide how many cases are needed
    begins_anew: ClassVar[bool] = False  # whether --resume is no error where nothing was run yet
    shared: ClassVar[Sequence[str]] = ()  # options that are the same for all results in a report
    result: ClassVar[type]  # a dataclass
    listed: ClassVar[str] = "drives"  # the results' key in report.json
    derived: ClassVar[Sequence[str]] = ()  # properties written there besides the fields

    # --- options and cases

    @abstractmethod
    def add_options(self, parser: Parser) -> None:
        """Add the options besides --out, --resume, --workers and --scheduler."""

    @abstractmethod
    def check(self, options: argparse.Namespace) -> None:
        """RunError for contradictory options; also the place to complete them."""

    @abstractmethod
    def cases(self, options: argparse.Namespace) -> Sequence[Case]:
        """All cases, in the order in which they are run."""

    def is_needed(self, case: Case, results: Sequence[Any]) -> bool:
        """Whether a case that was not run yet is still needed, after these results."""
        return True

    # --- one case

    @abstractmethod
    def drive(self, session: Session, case: Case) -> Any:
        """Run the case; returns the record of what happened. RunError if it could not be run.

        Processes started through the session end with it; `session.once` keeps what all cases use.
        """

    def judge(self, record: Any) -> Any:
        """The result of a record: the record itself if it was judged during the drive."""
        return record

    # --- all results

    def passed(self, results: Sequence[Any]) -> bool:
        """Whether the trial passed: exit code 0, else 1."""
        return all(each.passed for each in results)

    def line(self, result: Any) -> str:
        """A one-line summary of a result."""
        return result.line

    @abstractmethod
    def table(self, results: Sequence[Any]) -> str:
        """The table of all results, for the terminal."""

    def pictures(self, results: Sequence[Any], out: Path) -> list[str]:
        """Draw pictures of the results; returns their names."""
        return []

    def parse(self, arguments: Sequence[str]) -> argparse.Namespace:
        """Options from the command line, or RunError."""
        parser = Parser(
            package=self.package, prog=f"{self.program}.py", description=self.does,
            epilog=f"Exit code: 0 {self.good}, 1 not so, 2 could not run.")
        self.add_options(parser)
        parser.add_out(f"out/{self.program}", self.writes)
        parser.add_argument("--resume", action="store_true",
                            help="go on where the run that wrote there ended")
        parser.add_whole("--workers", 1, "cases at a time, each in a process of its own, by Dask",
                         least=1, most=MOST_WORKERS)
        parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, such as"
                            " tcp://host:8786, whose workers try the cases (SCHEDULER=)")
        options = parser.parse_args(arguments)
        if options.scheduler and options.workers > 1:
            raise RunError("--workers (WORKERS=) is for this machine, --scheduler (SCHEDULER=) for "
                           "others: give one")
        options.out = options.out.resolve()
        options.shared = {name: str(getattr(options, name)) for name in self.shared}
        self.check(options)
        self.options = options
        return options

    def named(self, option: str) -> str:
        """`out` or `resume` as messages name it."""
        return option_of(self.program, option)

    # --- report.json, which holds all results, and from which --resume reads them

    def values(self, results: Sequence[Any]) -> dict:
        """The content of report.json."""
        return {self.listed: [
            {**asdict(each), **{name: getattr(each, name) for name in self.derived}}
            for each in results]}

    def from_values(self, values: dict) -> list[Any]:
        """The results from what `values` wrote; KeyError, TypeError, ValueError if malformed."""
        return [from_json(self.result, each) for each in values[self.listed]]

    def earlier(self, options: argparse.Namespace) -> list[Any]:
        """The results to resume from; RunError if there are none, or shared options differ."""
        path = options.out / REPORT
        if self.begins_anew and not path.exists():
            return []
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            for name, value in values.get("options", {}).items():
                if value != options.shared[name]:
                    raise RunError(f"{path}: is of --{name.replace('_', '-')} {value};"
                                   f" give that again, or another {self.named('out')}")
            return self.from_values(values)
        except OSError as error:
            raise RunError(f"{path}: {error.strerror}; nothing to go on with") from error
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise RunError(f"{path}: no report of {self.program}: {error!r}") from error


def from_json(kind: Any, value: Any) -> Any:
    """An instance of `kind` from its asdict as JSON; KeyError or TypeError if fields do not fit."""
    if is_dataclass(kind):
        kinds = get_type_hints(kind)
        return kind(**{each.name: from_json(kinds[each.name], value[each.name])
                       for each in fields(kind)})
    if get_origin(kind) is tuple:
        return tuple(from_json(get_args(kind)[0], each) for each in value)
    kinds = get_args(kind) if isinstance(kind, UnionType) else (get_origin(kind) or kind,)
    if not isinstance(value, (*kinds, int) if float in kinds else kinds):
        raise TypeError(f"{value!r} is not of type {kind}")
    return value


def run_trial(trial: Trial, arguments: Sequence[str]) -> int:
    """Run the command line; returns the exit code."""
    def work() -> int:
        options = trial.parse(arguments)
        with results_folder(trial.program, options.out):
            return _run_cases(trial, options, arguments)

    return run_program(trial.program, work)


def _run_cases(trial: Trial, options: argparse.Namespace, arguments: Sequence[str]) -> int:
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
    except KeyboardInterrupt:
        drop_unread_output()  # Ctrl-C ends `tee`, too
        if tally.done:
            print(f"{tally.done} of {len(tally.cases)} cases are done; "
                  f"{trial.named('resume')} goes on with the others", file=sys.stderr)
        raise
    finally:
        if tally.results:  # finished cases are kept, however the run ended
            _show(trial, tally, options.out)
    if tally.failures:
        raise RunError(f"{len(tally.failures)} of {len(tally.cases)} cases could not be run; "
                       f"{trial.named('resume')} tries them again")
    return PASSED if trial.passed(tally.results) else NOT_PASSED


class Tally:
    """The results so far, in the order of the cases; those of no current case come first."""

    def __init__(self, trial: Trial, options: argparse.Namespace):
        self._trial, self._options = trial, options
        self.results = trial.earlier(options) if options.resume else []
        self.cases = trial.cases(options)
        self.failures: list[str] = []  # a line each
        self._place = {case.name: number for number, case in enumerate(self.cases)}

    @property
    def done(self) -> int:
        """How many of the cases have results."""
        return sum(self._number(each) >= 0 for each in self.results)

    def is_needed(self, case: Case) -> bool:
        """Whether a case still has to be run, given the results of those before it."""
        there = {result.name for result in self.results}
        before = [each for each in self.results if self._number(each) < self._place[case.name]]
        return case.name not in there and self._trial.is_needed(case, before)

    def take(self, result: Any, say: Callable[[str], None]) -> None:
        """Add a result, print its line and write the report."""
        self.results.append(result)
        self.results.sort(key=self._number)
        shown = "" if self._trial.open_ended else f"[{self.done}/{len(self.cases)}] "
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
                tally.take(trial.judge(trial.drive(session, case)), session.progress.say)


def _try_elsewhere(tally: Tally, trial: Trial, options: argparse.Namespace,
                   arguments: Sequence[str]) -> None:
    try:
        workers = importlib.import_module("evaluation.workers")
    except ImportError as error:
        raise RunError(f"{error.name} is not installed: scripts/setup.sh --workers") from error
    needed = [case for case in tally.cases if tally.is_needed(case)]
    say = StatusLine().say
    if needed:
        where = (f"on the workers of {options.scheduler}" if options.scheduler else
                 f"{options.workers} at a time")
        say(f"{len(needed)} cases, {where}; each has a line when it is done")
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

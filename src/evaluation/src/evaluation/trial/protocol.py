"""The interface of a trial: its cases, how one is set up and run, and how it is scored."""

from __future__ import annotations

import argparse
import json
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from types import UnionType
from typing import Any, ClassVar, get_args, get_origin, get_type_hints

from evaluation.trial.command_line import Parser
from run_session.failure import RunError
from run_session.session import Session

REPORT = "report.json"
MOST_WORKERS = 1000


@dataclass(frozen=True)
class Case:
    """One case: picklable; run twice, it gives the same files and the same result."""

    name: str  # unique among the cases; also that of its result


class Trial(ABC):
    """Cases that are set up, run and scored one by one; the runner does everything else.

    A result is an object with the `name` of its case. `setup`, `run` and `score` of a case run
    after one another in one process. Another process may run another case: it makes a trial of its
    own from the same arguments (`parse`) and is given the case.
    """

    package: ClassVar[str] = "evaluation"  # which contains the program
    program: ClassVar[str]
    does: ClassVar[str]  # for --help
    good: ClassVar[str]  # what exit code 0 means
    writes: ClassVar[str]  # the contents of the folder for results
    open_ended: ClassVar[bool] = False  # whether the results decide how many cases are needed
    shared: ClassVar[Sequence[str]] = ()  # options that are the same for all results in a report

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
    def setup(self, session: Session, case: Case) -> None:
        """Start what the case needs; processes started through the session end with it."""

    @abstractmethod
    def run(self) -> Any:
        """Run the case; returns the record of what happened. RunError if it could not be run."""

    def score(self, record: Any) -> Any:
        """The result of a record: the record itself if it was judged during the run."""
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

    @abstractmethod
    def values(self, results: Sequence[Any]) -> dict:
        """The content of report.json."""

    @abstractmethod
    def earlier(self, options: argparse.Namespace) -> list[Any]:
        """The results to resume from; RunError if there are none but should be."""

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
            raise RunError("--workers is for this machine, --scheduler for others: give one")
        options.out = options.out.resolve()
        options.shared = {name: str(getattr(options, name)) for name in self.shared}
        self.check(options)
        return options


class ReportedTrial(Trial):
    """A trial whose report.json holds all of its results, from which --resume reads them."""

    result: ClassVar[type]  # a dataclass
    listed: ClassVar[str] = "drives"  # the results' key in report.json
    derived: ClassVar[Sequence[str]] = ()  # properties written there besides the fields

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
        try:
            values = json.loads(path.read_text(encoding="utf-8"))
            for name, value in values.get("options", {}).items():
                if value != options.shared[name]:
                    raise RunError(f"{path}: is of --{name.replace('_', '-')} {value};"
                                   " give that again, or another --out")
            return self.from_values(values)
        except OSError as error:
            raise RunError(f"{path}: {error.strerror}; nothing to go on with") from error
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise RunError(f"{path}: no report of {self.program}: {error!r}") from error


def try_case(trial: Trial, session: Session, case: Case) -> Any:
    """The result of one case."""
    trial.setup(session, case)
    return trial.score(trial.run())


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

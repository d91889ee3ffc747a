"""Reports errors in a text while reading continues without the faulty part; limits their number."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import TypeVar

from bullet_sim.errors import SimulationError, shortened

logger = logging.getLogger(__name__)

MOST_LINES = 20  # for one world or robot with everything that it includes
LONGEST_LINE = 500  # characters
Read = TypeVar("Read")


@dataclass
class _Report:
    """Of one load: the lines, without repeated ones, and the files being read."""

    lines: set[str] = field(default_factory=set)
    files: list[str] = field(default_factory=list)


_report: ContextVar[_Report | None] = ContextVar("report", default=None)


@contextmanager
def reading(file: str = "") -> Iterator[None]:
    """Use around reading a text, or a `file` within it, whose name then begins each line.

    The outermost one counts the lines, and reports at the end how many more there were.
    """
    outer = _report.get()
    report = outer or _Report()
    report.files.append(file)
    token = _report.set(report)
    try:
        yield
    finally:
        _report.reset(token)
        report.files.pop()
        if outer is None and len(report.lines) > MOST_LINES:
            logger.error("and %d more such lines%s", len(report.lines) - MOST_LINES,
                         f", in {file} and what it includes" if file else "")


def mistake(message: object) -> None:
    """Log an error line, once per load."""
    report = _report.get() or _Report()
    file = report.files[-1] if report.files else ""
    _log_once(report, f"{file}: {message}" if file else str(message), logging.ERROR)


def remark(line: str) -> None:
    """Log a warning, once per load."""
    _log_once(_report.get() or _Report(), line, logging.WARNING)


def _log_once(report: _Report, line: str, level: int) -> None:
    if line in report.lines:
        return
    report.lines.add(line)
    if len(report.lines) <= MOST_LINES:
        logger.log(level, "%s", shortened(line, LONGEST_LINE))


def instead(error: SimulationError, used: object) -> None:
    """Log the error of a value for which another one, as text, is `used`."""
    mistake(f"{error}; {used} is used instead")


def or_without(read: Callable[..., Read], *arguments: object) -> Read | None:
    """The result of `read` with the arguments; None, with an error line, if it fails."""
    try:
        return read(*arguments)
    except SimulationError as error:
        mistake(f"{error}; left out")
        return None


def all_that_can(read: Callable[..., Read | None], elements: list, *others: object) -> list[Read]:
    """The results of `read` for each of the elements, without those that fail or give None."""
    found = (or_without(read, element, *others) for element in elements)
    return [one for one in found if one is not None]

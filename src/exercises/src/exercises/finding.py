"""What a check observed, and what it expected; the exceptions that end one early."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Finding:
    """One line of a check's output."""

    what: str
    seen: str
    wanted: str
    passed: bool

    def __str__(self) -> str:
        return f"{'pass' if self.passed else 'FAIL'}  {self.what}: {self.seen}," \
               f" wanted {self.wanted}"


def at_least(what: str, value: float, limit: float, unit: str = "") -> Finding:
    """A number that must not be below a limit."""
    return Finding(what, f"{value:.3g}{unit}", f"at least {limit:g}{unit}", value >= limit)


def at_most(what: str, value: float, limit: float, unit: str = "") -> Finding:
    """A number that must not be above a limit."""
    return Finding(what, f"{value:.3g}{unit}", f"at most {limit:g}{unit}", value <= limit)


def near(what: str, value: float, wanted: float, tolerance: float, unit: str = "") -> Finding:
    """A number that must be within a tolerance of another."""
    return Finding(what, f"{value:.3g}{unit}", f"{wanted:g}{unit} ± {tolerance:g}{unit}",
                   abs(value - wanted) <= tolerance)


def holds(what: str, seen: str, wanted: str, passed: bool) -> Finding:
    """Any other finding, in words."""
    return Finding(what, seen, wanted, bool(passed))


class CannotCheck(Exception):
    """The check could not run: one line with what, where, and what to type next."""


class TimeUp(BaseException):
    """The check takes too long; a learner's `except Exception` does not catch it."""


class Mistake(Exception):
    """An error in the learner's program that the check cannot continue after; one line."""

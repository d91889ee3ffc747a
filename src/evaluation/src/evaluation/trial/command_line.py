"""The command lines of the programs: a mistake is one line that says what to type instead."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable
from functools import partial
from pathlib import Path

from run_session.failure import RunError

MOST = 999_999          # of what is counted or seeds something
LARGEST_SEED = 999_999_999
LEAST_PACE, MOST_PACE = 0.01, 20.0  # no machine keeps up with more


class Parser(argparse.ArgumentParser):
    """Knows options by their whole names; its errors are RunErrors."""

    def __init__(self, package: str = "evaluation", **settings: object) -> None:
        super().__init__(**{"allow_abbrev": False, **settings})
        self._package = package  # that the program belongs to; none: it is a script in scripts/

    def error(self, message: str) -> None:
        """RunError that says where the options are listed."""
        start = f"rosrun {self._package} " if self._package else "scripts/"
        raise RunError(f"{message} (see: {start}{self.prog.split()[0]} --help)")  # before a verb

    def add_whole(self, flag: str, default: int | None, text: str, *, variable: str | None = None,
                  least: int = 0, most: int = MOST) -> None:
        """A whole number; `variable`: what the Makefile calls it, if not as a one-word option."""
        variable = flag[2:].upper() if variable is None else variable
        name = flag if "-" in variable or not variable else f"{flag} ({variable}=)"
        self.add_argument(
            flag, type=partial(whole, name, least=least, most=most), default=default, metavar="N",
            help=f"{text} ({default or 0})")

    def add_pace(self, text: str) -> None:
        """--real-time-factor, simulated seconds a second."""
        self.add_argument(
            "--real-time-factor", metavar="X", default=1.0, help=text, type=partial(
                number, "--real-time-factor (PACE=)", least=LEAST_PACE, most=MOST_PACE))

    def add_out(self, default: str, text: str) -> None:
        """--out, a folder."""
        self.add_argument("--out", type=Path, default=Path(default), metavar="DIR",
                          help=f"where {text} go ({default})")


def whole(name: str, text: str, least: int = 0, most: int = MOST) -> int:
    """A whole number written in digits, or RunError."""
    if not re.fullmatch(r"[0-9]{1,9}", text) or not least <= int(text) <= most:
        raise RunError(f"{name} must be a whole number, {least} to {most}; got {text!r}")
    return int(text)


def number(name: str, text: str, least: float, most: float, what: str = "a number") -> float:
    """A number written without an exponent, or RunError; `what` names it and its unit."""
    if not re.fullmatch(r"[0-9]{1,9}(\.[0-9]{1,6})?", text) or not least <= float(text) <= most:
        raise RunError(f"{name} must be {what}, {least:g} to {most:g}; got {text!r}")
    return float(text)


def one_of(kind: str, variable: str, names: Iterable[str], name: str) -> str:
    """The name, or RunError that says which there are; `variable` is what the Makefile calls it."""
    known = tuple(names)
    if name not in known:
        raise RunError(f"no {kind} {name!r} ({variable}=); there are: {', '.join(known) or 'none'}")
    return name

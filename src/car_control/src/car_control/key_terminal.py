"""Driving keys typed in a plain terminal, which does not report when a key is released."""

from __future__ import annotations

import contextlib
import logging
import os
import re
import select
import time
from collections.abc import Callable, Iterator

from node_basics.ending import single_keys

from car_control.keys import DRIVING_KEYS, QUIT_KEY, STOP_KEY, TerminalKeys

TEXT = (
    "Hold W or S to drive, A or D beside it to steer; space stops at once. Press Q to quit.\n"
    "A terminal does not report when a key is released: the car stops up to 0.7 s later."
)
PERIOD = 0.02  # s
ESCAPE = re.compile(r"\x1b(?:[\[O][0-9;]*(.)?)?")  # an arrow's letter, or another key's sequence
ARROWS = {"A": "w", "B": "s", "C": "d", "D": "a"}


def keys_in(text: str) -> str:
    """The keys for these characters: lower case, arrows as WASD, other sequences dropped."""
    return ESCAPE.sub(lambda found: ARROWS.get(found[1] or "", ""), text).lower()


class StatusLine(logging.Handler):
    """A line that is drawn in place; rospy's log lines come above it, on lines of their own."""

    WIDTH = 40

    def __init__(self) -> None:
        super().__init__()
        self._shown = ""

    def show(self, status: str) -> None:
        """Draw it, if it has changed."""
        if status != self._shown:
            self._shown = status
            self._draw(status)

    def emit(self, _record: logging.LogRecord) -> None:
        """Draw it again: the other handlers have written a log line."""
        self._draw(self._shown)

    def make_room(self, _record: logging.LogRecord) -> bool:
        """A filter that lets all pass: it empties the line before a log line is written."""
        self._draw("")
        print(end="\r", flush=True)
        return True

    def _draw(self, status: str) -> None:
        print(f"\r{status:{self.WIDTH}}", end="", flush=True)


@contextlib.contextmanager
def below_the_log(line: StatusLine) -> Iterator[None]:
    """Keep the line below rospy's log lines, meanwhile."""
    log = logging.getLogger("rosout")
    log.addFilter(line.make_room)
    log.addHandler(line)
    try:
        yield
    finally:
        log.removeHandler(line)
        log.removeFilter(line.make_room)


def run_terminal(terminal: int, turn: Callable[[frozenset[str]], str | None]) -> None:
    """Call `turn` repeatedly with the keys held, and show what it returns in one line.

    Ends with Q, with the terminal, or when `turn` returns None.
    """
    keys, line = TerminalKeys(), StatusLine()
    print(TEXT, flush=True)
    with single_keys(terminal), below_the_log(line):
        while True:
            text = _typed(terminal)
            typed = keys_in(text or "")
            for key in typed:
                if key in DRIVING_KEYS:
                    keys.press(key, time.monotonic())
                elif key == STOP_KEY:
                    keys.release_all()
            status = turn(keys.held(time.monotonic()))
            if status is None or text is None or QUIT_KEY in typed:
                break
            line.show(status)
    print()


def _typed(terminal: int) -> str | None:
    """The characters typed, "" after PERIOD without a key, None if the terminal is closed."""
    try:
        if not select.select([terminal], [], [], PERIOD)[0]:
            return ""
        return os.read(terminal, 1024).decode(errors="ignore") or None
    except OSError:
        return None

"""Driving keys typed in a plain terminal, which does not report when a key is released."""

from __future__ import annotations

import os
import re
import select
import time
from collections.abc import Callable

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


def run_terminal(terminal: int, turn: Callable[[frozenset[str]], str | None]) -> None:
    """Call `turn` repeatedly with the keys held, and show what it returns in one line.

    Ends with Q, with the terminal, or when `turn` returns None.
    """
    keys, shown = TerminalKeys(), ""
    print(TEXT, flush=True)
    with single_keys(terminal):
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
            if status != shown:
                shown = status
                print(f"\r{status:40}", end="", flush=True)
    print()


def _typed(terminal: int) -> str | None:
    """The characters typed, "" after PERIOD without a key, None if the terminal is closed."""
    try:
        if not select.select([terminal], [], [], PERIOD)[0]:
            return ""
        return os.read(terminal, 1024).decode(errors="ignore") or None
    except OSError:
        return None

"""A line that shows a run's progress: rewritten on a terminal, else one every ten seconds."""

from __future__ import annotations

import shutil
import sys
import time
from collections import deque
from collections.abc import Callable
from typing import TextIO

PLAIN_PERIOD = 10.0  # s, simulated
TERMINAL_PERIOD = 0.2  # s, wall
RATE_WINDOW = 5.0  # s, wall, over which the real-time factor is taken


class StatusLine:
    """Knows where to write and when a line is due; the text comes from the caller."""

    def __init__(self, stream: TextIO | None = None):
        self._stream = stream or sys.stdout
        self._in_place = self._stream.isatty()
        self._shown_at, self._next_plain = 0.0, 0.0
        self._times: deque[tuple[float, float]] = deque()
        self._open, self._part = False, ""

    @property
    def factor(self) -> float:
        """Real-time factor: simulated over wall time, of the last RATE_WINDOW."""
        (wall, simulated), (now, latest) = self._times[0], self._times[-1]
        return (latest - simulated) / (now - wall) if now > wall else 0.0

    def say(self, text: str) -> None:
        """Print a line that is not overwritten."""
        self.end()
        print(text, file=self._stream, flush=True)

    def status(self, text: str) -> None:
        """Show what is being waited for, on a terminal only."""
        if self._in_place:
            self._rewrite(text)

    def update(self, simulated: float, make_line: Callable[[], str], part: str = "") -> None:
        """Take another simulated time (s), which begins again with each part of the run.

        `make_line` is called if a line is due.
        """
        if part != self._part:
            self.end()
            self._times.clear()
            self._next_plain, self._part = 0.0, part
        now = time.monotonic()
        self._times.append((now, simulated))
        while now - self._times[0][0] > RATE_WINDOW:
            self._times.popleft()
        if self._in_place and now - self._shown_at >= TERMINAL_PERIOD:
            self._shown_at = now
            self._rewrite(make_line())
        elif not self._in_place and simulated >= self._next_plain:
            self._next_plain = (simulated // PLAIN_PERIOD + 1) * PLAIN_PERIOD
            self.say(make_line())

    def end(self) -> None:
        """Leave the line as it is and go to the next."""
        if self._open:
            print(file=self._stream, flush=True)
        self._open = False

    def _rewrite(self, text: str) -> None:
        shown = text[: shutil.get_terminal_size().columns - 1]  # a wrapped line cannot be rewritten
        print(f"\r{shown}\x1b[K", end="", file=self._stream, flush=True)
        self._open = True

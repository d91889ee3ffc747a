"""The run's progress line: rewritten in place on a terminal, one in ten seconds elsewhere."""

from __future__ import annotations

import shutil
import sys
import time
from collections import deque
from typing import TextIO

from evaluation.lap import LapScorer

PLAIN_PERIOD = 10.0  # s, simulated
TERMINAL_PERIOD = 0.2  # s, wall
RATE_WINDOW = 5.0  # s, wall, over which the real-time factor is taken


class Progress:
    """Shows how the drive stands."""

    def __init__(self, stream: TextIO = sys.stdout):
        self._stream, self._in_place = stream, stream.isatty()
        self._shown_at, self._next_plain = 0.0, 0.0
        self._times: deque[tuple[float, float]] = deque()
        self._open = False

    def say(self, text: str) -> None:
        """A line that stays."""
        self.end()
        print(text, file=self._stream, flush=True)

    def status(self, text: str) -> None:
        """What is being waited for; only a terminal shows it."""
        if self._in_place:
            self._rewrite(text)

    def show(self, drive: LapScorer) -> None:
        """The progress line, if one is due."""
        now, sample = time.monotonic(), drive.samples[-1]
        self._times.append((now, sample.time))
        while now - self._times[0][0] > RATE_WINDOW:
            self._times.popleft()
        if self._in_place and now - self._shown_at >= TERMINAL_PERIOD:
            self._shown_at = now
            self._rewrite(self._line(drive))
        elif not self._in_place and sample.time >= self._next_plain:
            self._next_plain = (sample.time // PLAIN_PERIOD + 1) * PLAIN_PERIOD
            self.say(self._line(drive))

    def end(self) -> None:
        """Leave the line as it is and go to the next."""
        if self._open:
            print(file=self._stream, flush=True)
        self._open = False

    def _rewrite(self, text: str) -> None:
        shown = text[: shutil.get_terminal_size().columns - 1]  # a wrapped line cannot be rewritten
        print(f"\r{shown}\x1b[K", end="", file=self._stream, flush=True)
        self._open = True

    def _line(self, drive: LapScorer) -> str:
        lap = min(len(drive.laps) + 1, drive.wanted_laps)
        return (
            f"simulated {drive.samples[-1].time:.1f} s | {drive.total.distance:.2f} m"
            f" | lap {lap}/{drive.wanted_laps} {drive.driven_share:4.0%}"
            f" | off line {drive.lateral * 100:+.1f} cm | real time x{self._factor():.2f}"
        )

    def _factor(self) -> float:
        (wall, simulated), (now, latest) = self._times[0], self._times[-1]
        return (latest - simulated) / (now - wall) if now > wall else 0.0

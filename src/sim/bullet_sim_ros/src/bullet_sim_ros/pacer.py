"""Holds simulated time to real time. The wall clock is read here only."""

from __future__ import annotations

import time

SLACK = 0.1  # s; further behind than this, lost time is given up, not caught up in a burst
GRAIN = 0.002  # s; sleeping for less than this costs more than it gives


class Pacer:
    """Waits until the wall clock has caught up with `factor` times real time; 0 never waits."""

    def __init__(self, factor: float = 1.0):
        self.factor = factor
        self._start: tuple[float, float] | None = None

    def restart(self) -> None:
        """Forget the past: after a pause, a reset or a change of factor."""
        self._start = None

    def wait(self, simulated: float) -> None:
        """Sleep if simulated time (s) is ahead of the wall."""
        if self.factor <= 0:
            return
        now = time.monotonic()
        if self._start is None:
            self._start = (now, simulated)
            return
        ahead = self._start[0] + (simulated - self._start[1]) / self.factor - now
        if ahead > GRAIN:
            time.sleep(ahead)
        elif ahead < -SLACK:
            self._start = (now, simulated)

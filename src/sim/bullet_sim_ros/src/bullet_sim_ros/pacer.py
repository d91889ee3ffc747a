"""Holds simulated time to real time. Only here does the wall clock decide."""

import time
from collections.abc import Callable

SLACK = 0.1  # s, wall: how much lost time is made up for; more than that is given up
CATCH_UP = 1.25  # lost time is made up for at this many times the wanted speed, not in a burst


class Pacer:
    """Simulated time runs at `factor` times real time or slower, and evenly; 0 never waits."""

    def __init__(self, factor: float = 1.0, clock: Callable[[], float] = time.monotonic):
        self.factor = factor
        self._clock = clock
        self.restart()

    def restart(self) -> None:
        """Forget the past: after a pause, a reset or a change of factor."""
        self._simulated: float | None = None  # s, the argument of the last `ahead`
        self._until = self._fair = 0.0  # s, wall: when that is due, with and without delays

    def ahead(self, simulated: float) -> float:
        """Seconds of wall time to wait before going on from this simulated time; 0: go on."""
        if self.factor <= 0:
            return 0.0
        now = self._clock()
        if self._simulated is None:
            self._simulated, self._until, self._fair = simulated, now, now
        elif simulated != self._simulated:
            step = (simulated - self._simulated) / self.factor
            self._simulated = simulated
            self._fair = max(self._fair + step, now - SLACK)
            if step < 0:  # something that is due earlier was added: waiting has lost no time
                self._until += step
            else:
                self._until = max(self._fair, self._until + step / CATCH_UP, now)
        return max(0.0, self._until - now)

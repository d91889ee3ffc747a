"""Decides when something with a rate is due, in simulated seconds."""

import math

from bullet_sim.errors import SimulationError

ROUNDING = 1e-9  # s; times are products of whole ticks and may be off by rounding


class Rate:
    """Due `rate_hz` times per simulated second, exact in the long run; 0 means at every update.

    SimulationError for a rate that is negative or not finite.
    """

    def __init__(self, rate_hz: float):
        if rate_hz < 0 or not math.isfinite(rate_hz):
            raise SimulationError(f"a rate of {rate_hz} Hz is not possible; 0 means every update")
        self._period = 1.0 / rate_hz if rate_hz else 0.0
        self._start = self._next = -math.inf
        self._count = 0

    def due(self, time: float) -> bool:
        """Whether it is due (`time` in s, simulated); to be called at each update.

        The first time it is. If time went back, or after a long pause, the count restarts.
        """
        if time + ROUNDING < self._next:
            if self._next - time <= self._period + ROUNDING:
                return False
            self._restart(time)
            return True
        if time - self._next > self._period:
            self._restart(time)
        else:
            self._count += 1
            self._next = self._start + self._count * self._period
        return True

    def _restart(self, time: float) -> None:
        self._start, self._count = time, 1
        self._next = time + self._period

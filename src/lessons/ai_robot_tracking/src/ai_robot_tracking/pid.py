"""A PID controller whose integral does not grow while its output is at a bound."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Gains:
    """Gains of the error, its integral, and its derivative."""

    p: float
    i: float
    d: float


class Pid:
    """One loop; times in s; the units of errors and outputs follow from the gains."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Reset the integral and the last error."""
        self._sum, self._last = 0.0, None

    def update(self, error: float, period: float, gains: Gains, low: float, high: float) -> float:
        """The output, between `low` and `high`, for an error `period` (s) after the last one."""
        change = (error - self._last) / period if self._last is not None and period > 0 else 0.0
        self._last = error
        grown = self._sum + error * period
        wanted = gains.p * error + gains.i * grown + gains.d * change
        bounded = min(max(wanted, low), high)
        if wanted == bounded or error * (wanted - bounded) < 0:  # anti-windup
            self._sum = grown
        return bounded

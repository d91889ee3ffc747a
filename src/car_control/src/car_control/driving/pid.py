"""A PID controller with clamped output, anti-windup and filtered derivative."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class PidGains:
    """Gains per unit of the error; the output has the unit of kp times the error."""

    kp: float
    ki: float = 0.0  # per second
    kd: float = 0.0  # seconds
    output_limit: float = math.inf  # the output stays within +- this
    derivative_time: float = 0.0  # s, time constant of the derivative's low-pass; 0: none


class Pid:
    """One loop. The integral is held while it would push the output further beyond its limit."""

    def __init__(self, gains: PidGains):
        self.gains = gains  # may change at any time: the integral is kept in units of the output
        self.reset()

    def reset(self) -> None:
        """Reset: no integral, and no derivative at the next error."""
        self._integral = 0.0  # in units of the output, so that a new ki makes no jump
        self._error: float | None = None
        self._derivative = 0.0  # units of the error per s

    def compute(self, error: float, period: float) -> float:
        """The output for this error, `period` seconds after the last one (0: the same time).

        A value that is not finite or a negative period raises ValueError and changes nothing.
        """
        if not (math.isfinite(error) and math.isfinite(period) and period >= 0):
            raise ValueError(f"error {error!r} and period {period!r} s: both must be finite")
        gains = self.gains
        self._derivative = self._filtered_derivative(error, period)
        self._error = error
        without_sum = gains.kp * error + gains.kd * self._derivative
        self._integral = self._next_integral(error, period, without_sum)
        return _clamp(without_sum + self._integral, gains.output_limit)

    def _filtered_derivative(self, error: float, period: float) -> float:
        if self._error is None or period == 0:
            return self._derivative
        # Backward Euler of a first-order low-pass: stable for every period.
        share = period / (period + self.gains.derivative_time)
        return self._derivative + share * ((error - self._error) / period - self._derivative)

    def _next_integral(self, error: float, period: float, without_sum: float) -> float:
        if self.gains.ki == 0:
            return 0.0
        limit = self.gains.output_limit
        step = self.gains.ki * error * period
        output = without_sum + self._integral + step
        if abs(output) > limit and output * step > 0:
            step = 0.0  # antiwindup: conditional integration (Astrom, Hagglund: PID Controllers)
        return _clamp(self._integral + step, limit)


def _clamp(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))

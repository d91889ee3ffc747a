"""A PID controller with a clamped integral, as control_toolbox's."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bullet_sim.control.parameters import ControllerParameters


@dataclass(frozen=True)
class PidGains:
    """Gains and the limits of the integral term, in the unit of the output."""

    p: float = 0.0
    i: float = 0.0
    d: float = 0.0
    i_clamp_max: float = 0.0  # 0 together with i_clamp_min: the integral has no effect
    i_clamp_min: float = 0.0
    antiwindup: bool = False  # clamp the integral of the error itself, not only its term

    @classmethod
    def from_parameters(cls, parameters: ControllerParameters, group: str = "pid") -> PidGains:
        """The gains in a group of parameters, of which only p is required."""
        def number(name: str, default: float = 0.0) -> float:
            return parameters.number(f"{group}/{name}", default)

        p = parameters.number(f"{group}/p")
        clamp = abs(number("i_clamp"))
        return cls(
            p, number("i"), number("d"),
            i_clamp_max=abs(number("i_clamp_max", clamp)),
            i_clamp_min=-abs(number("i_clamp_min", clamp)),
            antiwindup=parameters.flag(f"{group}/antiwindup", False),
        )


class Pid:
    """Call `compute` at each update; gains may be replaced in between."""

    def __init__(self, gains: PidGains):
        self.gains = gains
        self.reset()

    def reset(self) -> None:
        """Forget past errors."""
        self.error = self.error_rate = self.error_integral = 0.0
        self.output = 0.0
        self._last_error = 0.0

    def compute(self, error: float, period: float, error_rate: float | None = None) -> float:
        """The output for an error over the last `period` (s); 0 if it is not finite.

        Without `error_rate` the error's difference quotient is used, from an error of 0 at first.
        """
        if period <= 0.0 or not math.isfinite(error):
            return 0.0
        if error_rate is None:
            error_rate = (error - self._last_error) / period
        if not math.isfinite(error_rate):
            return 0.0
        self._last_error = self.error = error
        self.error_rate = error_rate
        gains = self.gains
        self.output = gains.p * error + gains.d * error_rate
        if gains.i:
            self.output += self._integrate(error, period, gains)
        return self.output

    def _integrate(self, error: float, period: float, gains: PidGains) -> float:
        """The integral term."""
        self.error_integral += error * period
        low, high = gains.i_clamp_min, gains.i_clamp_max
        if not gains.antiwindup:
            return min(max(gains.i * self.error_integral, low), high)
        bounds = sorted((low / gains.i, high / gains.i))
        self.error_integral = min(max(self.error_integral, bounds[0]), bounds[1])
        return gains.i * self.error_integral

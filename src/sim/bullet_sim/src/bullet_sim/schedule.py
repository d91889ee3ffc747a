"""When something that has a rate is due, counted in physics steps."""

from __future__ import annotations

import math

from bullet_sim.errors import SimulationError


class Schedule:
    """Due `rate_hz` times a simulated second; 0 means every step.

    A period that is no whole number of steps alternates between two lengths, so that the long-run
    rate is exact: 30 Hz at 1 kHz is due after 34, 67, 100 … steps, as in Gazebo's plugins that
    accumulate.
    """

    def __init__(self, rate_hz: float, timestep: float):
        if rate_hz < 0 or not math.isfinite(rate_hz):
            raise SimulationError(f"a rate of {rate_hz} Hz is not possible; 0 means every step")
        self.rate_hz = rate_hz
        self._period = 1.0 if rate_hz == 0 else max(1.0, 1.0 / (rate_hz * timestep))  # steps
        self.restart(0)

    def restart(self, tick: int) -> None:
        """Count from here."""
        self._origin = self._asked = tick
        self._count = 1
        self._next = tick + self._steps(1)

    def due(self, tick: int) -> bool:
        """Whether the moment has come; true once per period. A clock set back counts anew."""
        set_back = tick < self._asked
        self._asked = tick
        if set_back:
            self.restart(tick)
            return True
        if tick < self._next:
            return False
        # After a pause in asking, go on with the next moment in the future: no bursts.
        self._count = max(self._count, int((tick - self._origin) / self._period)) + 1
        self._next = self._origin + self._steps(self._count)
        return True

    def _steps(self, count: int) -> int:
        return math.ceil(count * self._period - 1e-9)

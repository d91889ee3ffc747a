"""Decides when something with a rate is due, counted in physics steps."""

import math

from bullet_sim.errors import SimulationError


class TickRate:
    """Due `rate_hz` times per simulated second; 0 means every step.

    A period that is not a whole number of steps alternates between two lengths, so that the
    long-run rate is exact: 30 Hz at 1 kHz is due after 34, 67, 100 … steps
    (gazebo_ros_diff_drive.cpp, UpdateChild). With `whole_steps` the period is rounded up: every 34
    steps, as if counted from the last time (gazebo_ros_p3d.cpp, UpdateChild). SimulationError for a
    rate that is negative or not finite.
    """

    def __init__(self, rate_hz: float, timestep: float, origin: int = 0,
                 whole_steps: bool = False):
        if rate_hz < 0 or not math.isfinite(rate_hz):
            raise SimulationError(f"a rate of {rate_hz} Hz is not possible; 0 means every step")
        self.rate_hz = rate_hz
        self.whole_steps = whole_steps
        self.restart(origin, timestep)

    def restart(self, tick: int, timestep: float | None = None) -> None:
        """Count from here, if given with another step length (s)."""
        self._origin = tick
        if timestep is not None:
            every = self.rate_hz == 0
            self._period = 1.0 if every else max(1.0, 1.0 / (self.rate_hz * timestep))  # steps
            if self.whole_steps:
                self._period = float(math.ceil(self._period - 1e-9))

    def next_tick(self, tick: int) -> int:
        """The first due tick after this one."""
        count = max(1, int((tick - self._origin) / self._period))
        while self._moment(count) <= tick:
            count += 1
        return self._moment(count)

    def _moment(self, count: int) -> int:
        return self._origin + math.ceil(count * self._period - 1e-9)

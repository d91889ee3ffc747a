"""A command that is only good for a while."""

from __future__ import annotations


class TimedCommand:
    """Some numbers and when they came; after `timeout` s they are zeros."""

    def __init__(self, size: int, timeout: float):
        self._zeros = (0.0,) * size
        self._timeout = timeout
        self.clear()

    @property
    def time(self) -> float:
        """When the last one came (s, simulated); minus infinity before the first."""
        return self._time

    def give(self, time: float, *values: float) -> None:
        """A new command."""
        self._time, self._values = time, values

    def clear(self) -> None:
        """Forget it."""
        self._time, self._values = float("-inf"), self._zeros

    def at(self, time: float) -> tuple[float, ...]:
        """What to do now. A command from the future is one from before a reset of time: too old."""
        return self._values if 0.0 <= time - self._time <= self._timeout else self._zeros

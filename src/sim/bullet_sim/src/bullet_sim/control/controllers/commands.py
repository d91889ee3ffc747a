"""The latest command of a controller, and how long it is valid."""

from collections.abc import Sequence

ROUNDING = 1e-9  # s; times are products of whole ticks and may be off by rounding


class Commands:
    """Numbers that were commanded last; with a time-out, numbers to fall back on after it."""

    def __init__(self, timeout: float = 0.0):
        self.timeout = timeout  # s, simulated; 0: a command never expires
        self.values: Sequence[float] = ()
        self._fallback: Sequence[float] | None = None
        self._taken_at: float | None = None

    def start(self, values: Sequence[float], fallback: Sequence[float] | None) -> None:
        """What holds until a command comes, and after a time-out; None keeps the last command."""
        self.values = values
        self._fallback = fallback
        self._taken_at = None

    def take(self, values: Sequence[float]) -> None:
        """A new command; its age counts from the next `at`."""
        self.values = values
        self._taken_at = None

    def at(self, time: float) -> Sequence[float]:
        """What is to be done at this time (s, simulated)."""
        if self.timeout and self._fallback is not None:
            if self._taken_at is None or time < self._taken_at:  # new, or time was reset
                self._taken_at = time
            elif time - self._taken_at > self.timeout - ROUNDING:
                self.values = self._fallback
        return self.values


class TimedCommand:
    """Some numbers and when they came (`time`, s, simulated); after `timeout` s they are zeros."""

    def __init__(self, size: int, timeout: float):
        self._zeros = (0.0,) * size
        self.timeout = timeout
        self.clear()

    def give(self, time: float, *values: float) -> None:
        """A new command."""
        self.time, self._values = time, values

    def clear(self) -> None:
        """Forget it."""
        self.time, self._values = float("-inf"), self._zeros  # before the first

    def at(self, time: float) -> tuple[float, ...]:
        """What to do now. A command from the future is one from before a reset of time: too old."""
        return self._values if 0.0 <= time - self.time <= self.timeout else self._zeros

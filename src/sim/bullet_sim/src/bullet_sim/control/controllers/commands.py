"""The latest command of a controller, and how long it is valid."""

from collections.abc import Sequence

ROUNDING = 1e-9  # s; times are products of whole ticks and may be off by rounding


class Commands:
    """The last command's numbers; with a time-out, numbers to fall back on after it."""

    def __init__(self, timeout: float = 0.0):
        self.timeout = timeout  # s, simulated; 0: a command never expires
        self.values: Sequence[float] = ()
        self._fallback: Sequence[float] | None = None
        self._taken_at: float | None = None

    def start(self, values: Sequence[float], fallback: Sequence[float] | None) -> None:
        """Set the values until a command comes and after a time-out; None: keep the command."""
        self.values = values
        self._fallback = fallback
        self._taken_at = None

    def take(self, values: Sequence[float]) -> None:
        """Take a new command; its age counts from the next `at`."""
        self.values = values
        self._taken_at = None

    def at(self, time: float) -> Sequence[float]:
        """The values to use at this time (s, simulated)."""
        if self.timeout and self._fallback is not None:
            if self._taken_at is None or time < self._taken_at:  # new, or time was reset
                self._taken_at = time
            elif time - self._taken_at > self.timeout - ROUNDING:
                self.values = self._fallback
        return self.values


class TimedCommand:
    """Some numbers and their time (`time`, s, simulated); they become zero after `timeout` s."""

    def __init__(self, size: int, timeout: float):
        self._zeros = (0.0,) * size
        self.timeout = timeout
        self.clear()

    def give(self, time: float, *values: float) -> None:
        """Take a new command."""
        self.time, self._values = time, values

    def clear(self) -> None:
        """Forget the command."""
        self.time, self._values = float("-inf"), self._zeros  # before any other

    def at(self, time: float) -> tuple[float, ...]:
        """The current values. A command from the future is from before a reset of time: expired."""
        return self._values if 0.0 <= time - self.time <= self.timeout else self._zeros

"""Keeps a commanded speed within limits of velocity, acceleration and jerk."""

from dataclasses import dataclass

UNBOUNDED = (float("-inf"), float("inf"))


@dataclass(frozen=True)
class SpeedLimits:
    """(minimum, maximum) of a speed in m/s or rad/s and of its first two derivatives."""

    velocity: tuple[float, float] = UNBOUNDED
    acceleration: tuple[float, float] = UNBOUNDED  # per s
    jerk: tuple[float, float] = UNBOUNDED  # per s^2


UNLIMITED = SpeedLimits()


class SpeedLimiter:
    """Remembers the last two speeds that it returned; call `limit` once per control period."""

    def __init__(self, limits: SpeedLimits):
        self._limits = limits
        self.restart()

    def restart(self) -> None:
        """Start from standstill."""
        self._last = self._before = 0.0

    def limit(self, wanted: float, period: float) -> float:
        """The allowed speed nearest to `wanted`, `period` s after the last one."""
        limits, last = self._limits, self._last
        # SpeedLimiter::limit_jerk (diff_drive_controller's speed_limiter.cpp) gives jerk twice its
        # nominal effect, so the limits in published configurations mean that.
        bend = 2.0 * period * period
        speed = _within(wanted, limits.jerk, bend, last + (last - self._before))
        speed = _within(speed, limits.acceleration, period, last)
        speed = _within(speed, limits.velocity)
        self._before, self._last = self._last, speed
        return speed


def _within(value: float, bounds: tuple[float, float], scale: float = 1.0,
            centre: float = 0.0) -> float:
    """`value` clamped to centre + scale * bounds."""
    if bounds == UNBOUNDED:
        return value
    least, greatest = bounds
    return max(centre + least * scale, min(centre + greatest * scale, value))

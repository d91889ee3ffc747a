"""Velocities (vx, vy, omega) in the base frame, m/s and rad/s: those that may be commanded next."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class Command:
    """A velocity, and its trajectory (M, 3), poses in the costmap's frame."""

    vx: float
    vy: float
    omega: float
    trajectory: np.ndarray

    @property
    def velocity(self) -> np.ndarray:
        """(vx, vy, omega)."""
        return np.array([self.vx, self.vy, self.omega])

    def within(self, limits: Limits) -> Command:
        """The same, limited to `limits`."""
        vx, vy, omega = map(float, limits.clip(self.velocity))
        return replace(self, vx=vx, vy=vy, omega=omega)


@dataclass(frozen=True)
class Limits:
    """Velocities that may be commanded: 0, and `low` (3,) to `high` (3,), up to `speed`, m/s."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    speed: float = np.inf

    def clip(self, velocity: np.ndarray) -> np.ndarray:
        """The nearest velocity (3,) within them; `speed` keeps its direction."""
        found = np.clip(velocity, np.minimum(self.low, 0.0), np.maximum(self.high, 0.0))
        found[:2] *= min(self.speed / max(np.hypot(found[0], found[1]), 1e-9), 1.0)
        return found

    @property
    def fastest(self) -> tuple[float, float]:
        """Speed, m/s, and turn rate, rad/s, that no command exceeds."""
        most = np.maximum(np.abs(self.low), np.abs(self.high))
        return float(min(np.hypot(most[0], most[1]), self.speed)), float(most[2])


def window(velocity: np.ndarray, low: np.ndarray, high: np.ndarray, acceleration: np.ndarray,
           duration: float, least: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The lowest and the highest velocity (3,) reachable in `duration`, s, within the limits.

    From a velocity outside the limits it is the nearest within: a measurement must not lead to
    commands beyond them. `least` (3,): the slowest that is worth commanding. Below it, a robot can
    have it at once in either direction: otherwise it would never start to turn from standstill, or
    to drive from a turn.
    """
    reach = np.asarray(acceleration) * duration
    lowest, highest = velocity - reach, velocity + reach
    lowest = np.where(lowest < least, np.minimum(lowest, -np.asarray(least)), lowest)
    highest = np.where(highest > -np.asarray(least), np.maximum(highest, least), highest)
    lowest = np.clip(lowest, low, high)
    return lowest, np.maximum(lowest, np.clip(highest, low, high))


def samples(low: float, high: float, count: int) -> np.ndarray:
    """`count` velocities evenly from `low` to `high`; plus 0 if it is between them."""
    if high - low < 1e-9:
        return np.array([low])
    found = np.linspace(low, high, max(count, 2))
    if low < 0.0 < high:
        found = np.unique(np.append(found[np.abs(found) > 1e-6], 0.0))
    return found


def all_samples(low: np.ndarray, high: np.ndarray, counts: tuple[int, int, int]) -> np.ndarray:
    """All combinations of the samples in x, y and yaw, (S, 3)."""
    axes = [samples(low[n], high[n], counts[n]) for n in range(3)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def slowed(velocity: np.ndarray, acceleration: np.ndarray, period: float) -> np.ndarray:
    """The next velocity (3,) while braking to standstill."""
    size = np.maximum(np.abs(velocity) - np.asarray(acceleration) * period, 0.0)
    return np.sign(velocity) * size


def turning(angle: float, omega: float, least: float, most: float, acceleration: float,
            period: float) -> float:
    """The next omega, rad/s, of a turn by `angle`, rad, that ends at standstill.

    Between `least` and `most`, slow enough to brake over the angle that is left, and changed from
    the current `omega` by no more than the acceleration allows in a period, but never above
    `most`.
    """
    fastest = min(most, np.sqrt(2 * acceleration * abs(angle)))
    wanted = np.sign(angle) * max(min(fastest, abs(angle) / period), min(least, most))
    near = np.clip(wanted, omega - acceleration * period, omega + acceleration * period)
    return float(np.clip(near, -most, most))

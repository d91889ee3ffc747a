"""Velocities (vx, vy, omega) in the base frame, m/s and rad/s: what may be commanded next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Command:
    """A velocity, and where it leads: `trajectory` (M, 3), poses in the costmap's frame."""

    vx: float
    vy: float
    omega: float
    trajectory: np.ndarray

    @property
    def velocity(self) -> np.ndarray:
        """(vx, vy, omega)."""
        return np.array([self.vx, self.vy, self.omega])


def window(velocity: np.ndarray, low: np.ndarray, high: np.ndarray, acceleration: np.ndarray,
           duration: float, least: np.ndarray | float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The least and the greatest velocity (3,) that can be had in `duration`, s, within limits.

    A velocity outside the limits is brought back as fast as the acceleration allows. `least` (3,):
    the slowest that is worth commanding. Who comes below it can have it at once in either
    direction: else a robot would never come from standing to turning, or to driving from a turn.
    """
    reach = np.asarray(acceleration) * duration
    lowest, highest = velocity - reach, velocity + reach
    lowest = np.where(lowest < least, np.minimum(lowest, -np.asarray(least)), lowest)
    highest = np.where(highest > -np.asarray(least), np.maximum(highest, least), highest)
    lowest, highest = (np.minimum(np.maximum(low, lowest), np.maximum(velocity + reach, lowest)),
                       np.maximum(np.minimum(high, highest), np.minimum(velocity - reach, highest)))
    return lowest, np.maximum(lowest, highest)


def samples(low: float, high: float, count: int) -> np.ndarray:
    """`count` velocities from `low` to `high`, evenly; 0 is one more where it lies between."""
    if high - low < 1e-9:
        return np.array([low])
    found = np.linspace(low, high, max(count, 2))
    if low < 0.0 < high:
        found = np.unique(np.append(found[np.abs(found) > 1e-6], 0.0))
    return found


def all_samples(low: np.ndarray, high: np.ndarray, counts: tuple[int, int, int]) -> np.ndarray:
    """Each of the samples in x with each in y and each in yaw, (S, 3)."""
    axes = [samples(low[n], high[n], counts[n]) for n in range(3)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def slowed(velocity: np.ndarray, acceleration: np.ndarray, period: float) -> np.ndarray:
    """The next velocity (3,) on the way to standing still."""
    size = np.maximum(np.abs(velocity) - np.asarray(acceleration) * period, 0.0)
    return np.sign(velocity) * size


def turning(angle: float, omega: float, least: float, most: float, acceleration: float,
            period: float) -> float:
    """The next omega, rad/s, of a turn by `angle`, rad, that ends standing.

    Between `least` and `most`, no faster than can be braked over the angle that is left, and no
    further from the present `omega` than the acceleration allows in a period.
    """
    fastest = min(most, np.sqrt(2 * acceleration * abs(angle)))
    wanted = np.sign(angle) * max(min(fastest, abs(angle) / period), min(least, most))
    return float(np.clip(wanted, omega - acceleration * period, omega + acceleration * period))

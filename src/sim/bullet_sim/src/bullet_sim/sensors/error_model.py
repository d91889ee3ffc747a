"""The errors of hector_gazebo's sensors: scale, constant offset, slow drift, and white noise."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bullet_sim.world import World

HOUR = 3600.0  # s, time constant of a drift unless a file gives another


@dataclass(frozen=True)
class ErrorParameters:
    """One value for each component, in the reading's unit unless another one is named."""

    offset: tuple[float, ...]
    drift: tuple[float, ...]  # standard deviation of the drift
    drift_frequency: tuple[float, ...]  # 1/s, reciprocal of the drift's time constant
    gaussian_noise: tuple[float, ...]  # standard deviation of the white noise
    scale_error: tuple[float, ...]  # factor on the true value, 1 for none

    @staticmethod
    def none(size: int) -> ErrorParameters:
        """A sensor with `size` components and no errors."""
        zeros = (0.0,) * size
        return ErrorParameters(zeros, zeros, (1.0 / HOUR,) * size, zeros, (1.0,) * size)


class ErrorModel:
    """value x scale + offset + drift + noise; all random numbers follow from seed, name and tick.

    The drift is a Gauss-Markov process whose deviation is `drift` at any update rate (in
    SensorModel_::update in hector_gazebo_plugins' sensor_model.h it shrinks with the rate). Its
    first value is drawn with that deviation.
    """

    def __init__(self, world: World, name: str, parameters: ErrorParameters):
        self._world, self._name = world, name
        self.parameters = parameters
        self.restart()

    def restart(self) -> None:
        """Draw a new initial drift."""
        random = self._world.random(f"{self._name} start")
        self.drift = random.normal(0.0, self.parameters.drift)

    def set_drift(self, drift: np.ndarray) -> None:
        """Continue from this drift, (components,)."""
        self.drift = np.array(drift, dtype=float)

    @property
    def drifts(self) -> bool:
        """Whether it also changes between readings."""
        return any(self.parameters.drift) or bool(self.drift.any())

    @property
    def bias(self) -> np.ndarray:
        """The current offset plus drift, (components,)."""
        return self.drift + self.parameters.offset

    def update(self, elapsed: float) -> np.ndarray:
        """Advance by some time (s) and return the additive error of this tick, (components,)."""
        p = self.parameters
        drifts, noisy = self.drifts, any(p.gaussian_noise)
        if drifts:
            keep = np.exp(-elapsed * np.array(p.drift_frequency))
            self.drift = keep * self.drift
        if noisy or drifts:
            white = self._world.random(self._name).standard_normal((2, len(self.drift)))
        if drifts:
            self.drift += np.sqrt(1.0 - keep ** 2) * p.drift * white[0]
        return self.bias + white[1] * p.gaussian_noise if noisy else self.bias

    def apply(self, value: np.ndarray, elapsed: float) -> np.ndarray:
        """The sensor's reading of a true value, (components,)."""
        return np.multiply(value, self.parameters.scale_error) + self.update(elapsed)


def attitude_error(bias: np.ndarray, yaw: float, gravity: float) -> tuple[float, ...]:
    """Unit quaternion, in world axes, of the level error caused by an accelerometer's bias.

    `bias` is in world axes, m/s^2; `gravity` a magnitude, m/s^2 (0: no error); `yaw` in rad.
    """
    tilt = (0.0, 0.0) if gravity == 0.0 else (0.5 * bias[1] / gravity, -0.5 * bias[0] / gravity)
    length = math.hypot(1.0, *tilt)
    x, y, w = tilt[0] / length, tilt[1] / length, 1.0 / length
    s, c = math.sin(yaw / 2), math.cos(yaw / 2)
    return (c * x - s * y, c * y + s * x, s * w, c * w)

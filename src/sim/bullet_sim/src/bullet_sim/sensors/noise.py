"""Gazebo's noise on readings: `<noise>` of SDF, gaussian and gaussian_quantized."""

from collections.abc import Sequence

import numpy as np

from bullet_sim.description import Noise
from bullet_sim.world import World

KINDS = ("gaussian", "gaussian_quantized")


class SensorNoise:
    """Noise of one sensor, with its biases, which are drawn once per seed and name."""

    def __init__(self, world: World, name: str, noises: Sequence[Noise]):
        """`noises` has one entry for each component of a reading, or a single one for all."""
        self._world, self._name = world, name
        active = [noise if noise.type in KINDS else Noise() for noise in noises]
        self.active = any(noise.type in KINDS for noise in noises)
        self._mean = np.array([noise.mean for noise in active])
        self._stddev = np.abs([noise.stddev for noise in active])
        self._precision = np.array([
            noise.precision if noise.type == "gaussian_quantized" else 0.0 for noise in active])
        random = world.random(f"{name} bias", tick=0)
        size = random.normal([noise.bias_mean for noise in active],
                             np.abs([noise.bias_stddev for noise in active]))
        self.bias = size * random.choice([-1.0, 1.0], len(active))

    def apply(self, values: np.ndarray) -> np.ndarray:
        """Noisy copies of this tick's readings, (..., components) or any shape for a single one."""
        if not self.active:
            return values
        random = self._world.random(self._name)
        noisy = values + self.bias + random.normal(self._mean, self._stddev, values.shape)
        coarse = np.where(self._precision > 0.0, self._precision, 1.0)
        return np.where(self._precision > 0.0, np.round(noisy / coarse) * coarse, noisy)

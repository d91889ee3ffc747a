"""Planar laser range finder: rays against collision shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bullet_sim.description import SensorDescription
from bullet_sim.errors import FormatError
from bullet_sim.model import Link
from bullet_sim.world import World


@dataclass(frozen=True)
class LaserReading:
    """One sweep in the laser's own frame, counter-clockwise from angle_min."""

    time: float  # s, simulated
    ranges: np.ndarray  # (n,) float32 m; inf: nothing hit, -inf: nearer than range_min
    intensities: np.ndarray  # (n,) float32, laser_retro of what was hit
    angle_min: float  # rad
    angle_max: float  # rad, direction of the last beam
    range_min: float  # m
    range_max: float  # m


class Laser:
    """Gazebo's ray sensor: each ray starts at range_min, so the housing around it is not seen."""

    def __init__(self, world: World, link: Link, description: SensorDescription):
        if description.ray is None:
            raise FormatError(f"sensor {description.name} of {link.scoped_name} has no <ray>")
        self._world = world
        self._link = link
        self._description = description
        self.ray = description.ray
        count = max(1, round(self.ray.samples * self.ray.resolution))
        angles = np.linspace(self.ray.min_angle, self.ray.max_angle, count)
        self._beams = np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=1)
        self._name = f"{link.scoped_name}::{description.name}"

    def sample(self) -> LaserReading:
        """Cast all beams from where the sensor is now."""
        ray = self.ray
        matrix = (self._link.pose * self._description.pose).matrix()
        beams = self._beams @ matrix[:3, :3].T
        starts = matrix[:3, 3] + beams * ray.range_min
        ends = matrix[:3, 3] + beams * ray.range_max
        hits = self._world.cast_rays(starts, ends)
        ranges = ray.range_min + hits.fraction * (ray.range_max - ray.range_min)
        ranges = self._with_noise(ranges)
        limited = np.where(ranges >= ray.range_max, np.inf, ranges)
        limited[ranges <= ray.range_min] = -np.inf
        return LaserReading(self._world.time, limited.astype(np.float32),
                            hits.retro.astype(np.float32), ray.min_angle, ray.max_angle,
                            ray.range_min, ray.range_max)

    def _with_noise(self, ranges: np.ndarray) -> np.ndarray:
        noise = self.ray.noise
        if noise.type != "gaussian":
            return ranges
        # Gazebo draws for every ray, hit or not; a miss stays a miss.
        random = self._world.random(self._name)
        noisy = ranges + random.normal(noise.mean, noise.stddev, ranges.shape)
        noisy = np.clip(noisy, self.ray.range_min, self.ray.range_max)
        return np.where(ranges >= self.ray.range_max, ranges, noisy)

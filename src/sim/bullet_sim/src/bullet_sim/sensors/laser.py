"""Laser range finder: rays against collision shapes, with REP 117's infinities."""

from dataclasses import dataclass

import numpy as np

from bullet_sim.description import SensorDescription
from bullet_sim.link import Link
from bullet_sim.sensors.noise import SensorNoise
from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim.world import World


@dataclass(frozen=True)
class LaserReading:
    """One sweep in the laser's own frame, counter-clockwise from angle_min."""

    time: float  # s, simulated
    ranges: np.ndarray  # (n,) float32 m; inf: nothing hit, -inf: nearer than range_min
    intensities: np.ndarray  # (n,) float32, laser_retro of the link that was hit
    angle_min: float  # rad
    angle_max: float  # rad, direction of the last beam
    range_min: float  # m
    range_max: float  # m
    rows: int  # of n / rows beams each, the lowest first


class Laser:
    """Gazebo's ray sensor; its noise does not turn a hit into a miss, or a miss into a hit.

    FormatError for impossible rays.
    """

    def __init__(self, world: World, link: Link, description: SensorDescription):
        self.fan = RayFan(world, link, description)
        self.ray = self.fan.ray
        self._world = world
        self._noise = SensorNoise(
            world, f"{link.scoped_name}::{description.name}", [self.ray.noise])

    def measure(self) -> tuple[np.ndarray, np.ndarray]:
        """Ranges in m with noise and infinities, and laser_retro, both (rows, columns)."""
        ray = self.ray
        distances, retro = self.fan.cast()
        ranges = np.clip(self._noise.apply(distances), ray.range_min, ray.range_max)
        ranges = np.where(distances >= ray.range_max, np.inf, ranges)
        return np.where(distances <= ray.range_min, -np.inf, ranges), retro

    def sample(self) -> LaserReading:
        """Cast all beams from the sensor's current pose."""
        ray = self.ray
        ranges, retro = self.measure()
        return LaserReading(
            self._world.time, ranges.ravel().astype(np.float32), retro.ravel().astype(np.float32),
            ray.min_angle, ray.max_angle, ray.range_min, ray.range_max, self.fan.shape[0])

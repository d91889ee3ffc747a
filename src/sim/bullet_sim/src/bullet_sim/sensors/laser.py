"""Laser range finder: rays against collision shapes, with REP 117's infinities."""

import logging
import math
from dataclasses import dataclass

import numpy as np

from bullet_sim.description import SensorDescription
from bullet_sim.errors import FormatError
from bullet_sim.link import Link
from bullet_sim.sensors.noise import SensorNoise
from bullet_sim.world import World

log = logging.getLogger(__name__)

# Of a sweep: it takes about a second, during which no request is answered.
MOST_RAYS = 100_000


class RayFan:
    """Rays against collision shapes, arranged as in Gazebo's MultiRayShape::Init.

    A row has `samples` x `resolution` rays. A single ray points straight ahead, whatever the
    angles. Rays begin at range_min, so the housing around the sensor is not seen. FormatError
    without a <ray>.
    """

    def __init__(self, world: World, link: Link, description: SensorDescription):
        if description.ray is None:
            raise FormatError(f"sensor {description.name} of {link.scoped_name} has no <ray>")
        self._world, self._link, self._pose = world, link, description.pose
        self.ray = ray = description.ray
        columns, rows = count(ray.samples, ray.resolution), count(
            ray.vertical_samples, ray.vertical_resolution)
        if columns * rows > MOST_RAYS:
            asked, (columns, rows) = (columns, rows), fewer_rays(columns, rows)
            log.warning("sensor %s of %s has %d x %d rays, but at most %d are cast: %d x %d "
                        "over the same angles are used", description.name, link.scoped_name,
                        *asked, MOST_RAYS, columns, rows)
        self.shape = rows, columns
        self.azimuths = angles(ray.min_angle, ray.max_angle, columns)  # rad, (columns,)
        self.elevations = angles(ray.vertical_min_angle, ray.vertical_max_angle, rows)  # up is +
        across, up = np.meshgrid(self.azimuths, self.elevations)
        self.directions = np.stack(  # (rows, columns, 3) unit vectors in the sensor's frame
            [np.cos(up) * np.cos(across), np.cos(up) * np.sin(across), np.sin(up)], axis=-1)

    def cast(self) -> tuple[np.ndarray, np.ndarray]:
        """Distances, m (range_max: nothing was hit), and laser_retro, both (rows, columns)."""
        ray = self.ray
        matrix = (self._link.pose * self._pose).matrix()
        beams = self.directions.reshape(-1, 3) @ matrix[:3, :3].T
        hits = self._world.cast_rays(matrix[:3, 3] + beams * ray.range_min,
                                     matrix[:3, 3] + beams * ray.range_max)
        distances = ray.range_min + hits.fraction * (ray.range_max - ray.range_min)
        return distances.reshape(self.shape), hits.retro.reshape(self.shape)

    def nearest(self) -> float:
        """Distance to the nearest object, m, as measured by sonars and range finders.

        If nothing is near it is range_max. The ray's own SDF noise is not added.
        """
        return float(self.cast()[0].min())


def fewer_rays(columns: int, rows: int) -> tuple[int, int]:
    """The numbers of columns and rows that are cast; the larger of the two is reduced first."""
    across = columns > rows
    longer, shorter = max(columns, rows), min(columns, rows)
    shorter = min(shorter, math.isqrt(MOST_RAYS))
    longer = min(longer, MOST_RAYS // shorter)
    return (longer, shorter) if across else (shorter, longer)


def count(samples: int, resolution: float) -> int:
    """Rays of one row or column; at least one."""
    return max(1, int(samples * resolution))


def angles(first: float, last: float, number: int) -> np.ndarray:
    """`number` directions, evenly from the first angle to the last, rad."""
    return np.linspace(first, last, number) if number > 1 else np.zeros(1)


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

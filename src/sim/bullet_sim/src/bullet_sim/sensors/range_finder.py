"""Sonar and infrared range finders: the nearest thing within a cone of rays."""

from __future__ import annotations

from bullet_sim.description import SensorDescription
from bullet_sim.link import Link
from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim.world import World


class RangeFinder:
    """One distance; where nothing is near it is range_max. The ray's own SDF noise is not added."""

    def __init__(self, world: World, link: Link, description: SensorDescription):
        self.fan = RayFan(world, link, description)
        self.ray = self.fan.ray

    def sample(self) -> float:
        """Distance to the nearest thing, m."""
        distances, _ = self.fan.cast()
        return float(distances.min())

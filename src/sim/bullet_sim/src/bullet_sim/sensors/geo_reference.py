"""From the flat world to latitude and longitude, on the WGS84 ellipsoid."""

import math
from dataclasses import dataclass

from bullet_sim.pose import Vector3

EQUATORIAL_RADIUS = 6378137.0  # m, WGS84
FLATTENING = 1.0 / 298.257223563  # WGS84
ECCENTRICITY_2 = FLATTENING * (2.0 - FLATTENING)


@dataclass(frozen=True)
class GeoReference:
    """The location on Earth of the world's origin."""

    latitude_deg: float
    longitude_deg: float
    altitude: float  # m
    heading: float  # rad, compass direction of the world's x axis: 0 north, pi/2 east

    def north_west_up(self, vector: Vector3) -> Vector3:
        """A vector in the world's axes, rotated to north, west and up."""
        x, y, z = vector
        s, c = math.sin(self.heading), math.cos(self.heading)
        return (c * x + s * y, -s * x + c * y, z)

    def geodetic(self, position: Vector3) -> Vector3:
        """Latitude, longitude in degrees and altitude in m of a point near the origin.

        To first order in the distance, as in hector's gazebo_ros_gps.cpp, Update: 0.1 m off at a
        distance of 1 km.
        """
        north, west, up = self.north_west_up(position)
        squeeze = 1.0 / (1.0 - ECCENTRICITY_2 * math.sin(math.radians(self.latitude_deg)) ** 2)
        prime_vertical = EQUATORIAL_RADIUS * math.sqrt(squeeze)
        meridian = prime_vertical * (1.0 - ECCENTRICITY_2) * squeeze
        parallel = prime_vertical * math.cos(math.radians(self.latitude_deg))
        return (self.latitude_deg + math.degrees(north / meridian),
                self.longitude_deg - math.degrees(west / parallel),
                self.altitude + up)

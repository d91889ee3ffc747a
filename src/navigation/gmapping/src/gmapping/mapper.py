"""From scan messages to the algorithm and back; no topics, no clock: node and replay share it."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from sensor_msgs.msg import LaserScan

from nav_algorithms.particle_slam import ParticleSlam, SlamSettings
from nav_nodes.mount import Mount
from nav_nodes.parameters import ParameterError

TABLE = Path("params/slam_gmapping.yaml")  # below the package's folder
BEYOND = 0.01  # m below the sensor's reach a range begins to say nothing
LARGEST = 5e8  # cells, of 8 bytes while it is made


def settings_from(values: dict[str, Any], range_max: float) -> SlamSettings:
    """The algorithm's settings, for a laser that reaches so far, m."""
    chosen = {field.name: values[field.name] for field in fields(SlamSettings)}
    if chosen["maxRange"] < 0:
        chosen["maxRange"] = range_max - BEYOND
    if chosen["maxUrange"] < 0:
        chosen["maxUrange"] = chosen["maxRange"]
    return SlamSettings(**chosen)


def check_extent(values: dict[str, Any]) -> None:
    """Raises ParameterError for a map that has no cells, or too many."""
    cells = 1.0
    for low, high in (("xmin", "xmax"), ("ymin", "ymax")):
        if not values[low] < values[high]:
            raise ParameterError(f"~{low} is {values[low]}, but must be below ~{high}, "
                                 f"{values[high]}")
        cells *= (values[high] - values[low]) / values["delta"]
    if not cells <= LARGEST:
        raise ParameterError(f"~delta is {values['delta']}, but then the map from ~xmin, ~ymin to "
                             f"~xmax, ~ymax has {cells:.0e} cells, more than {LARGEST:.0e}: write "
                             f"a smaller extent, it grows where needed")


def ranges_of(scan: LaserScan) -> np.ndarray:
    """(N,), m; below range_min stands range_max: as upstream, nothing was there."""
    ranges = np.array(scan.ranges, float)
    with np.errstate(invalid="ignore"):
        return np.where(ranges < scan.range_min, scan.range_max, ranges)


class Mapper:
    """Made with the first scan's settings; one laser, one robot."""

    def __init__(self, values: dict[str, Any]) -> None:
        """`values` by the names of the parameter table; raises ParameterError."""
        check_extent(values)
        self._values = values
        self._seen = 0
        self.slam: ParticleSlam | None = None

    def is_wanted(self) -> bool:
        """Whether the next scan is one of those that throttle_scans lets through; counts it."""
        self._seen += 1
        return (self._seen - 1) % self._values["throttle_scans"] == 0

    def take(self, scan: LaserScan, odometry: np.ndarray, mount: Mount) -> bool:
        """True if the scan was used. `odometry` (x, y, yaw) of the robot at the scan's stamp."""
        if self.slam is None:
            self.slam = ParticleSlam(settings_from(self._values, scan.range_max),
                                     self._values["seed"])
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        return self.slam.add(scan.header.stamp.to_sec(), odometry, ranges_of(scan),
                             -angles if mount.upside_down else angles, mount.pose)

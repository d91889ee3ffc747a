"""Connects scan messages with the algorithm; no topics, no clock: used by node and replay."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from sensor_msgs.msg import LaserScan

from nav_algorithms import poses
from nav_algorithms.particle_slam import ParticleSlam, SlamSettings
from nav_nodes.laser_mount import Mount
from nav_nodes.parameters import ParameterError

TABLE = Path("params/slam_gmapping.yaml")  # below the package's folder
BEYOND = 0.01  # m below the sensor's maximum, from which on a range counts as no return
LARGEST = 5e8  # cells, of 8 bytes each while the map is built
LARGEST_SCAN = 5e7  # cells around one scan, of 16 bytes or more: 177 m to each side at 5 cm


class ScanError(ValueError):
    """A scan that cannot be used for a map; the text says why and what to change."""


def settings_from(values: dict[str, Any], range_max: float) -> SlamSettings:
    """The algorithm's settings, for a laser with this maximum range, m."""
    chosen = {field.name: values[field.name] for field in fields(SlamSettings)}
    if chosen["maxRange"] < 0:
        chosen["maxRange"] = range_max - BEYOND
    if chosen["maxUrange"] < 0:
        chosen["maxUrange"] = chosen["maxRange"]
    return SlamSettings(**chosen)


def check_extent(values: dict[str, Any]) -> None:
    """Raises ParameterError if the map would have no cells, or too many."""
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
    """Ranges (N,), m; those below range_min become range_max (no return), as upstream."""
    ranges = np.array(scan.ranges, float)
    with np.errstate(invalid="ignore"):
        return np.where(ranges < scan.range_min, scan.range_max, ranges)


class Mapper:
    """Builds the map of one robot with one laser; the first scan determines the settings."""

    def __init__(self, values: dict[str, Any]) -> None:
        """`values` by the names of the parameter table; raises ParameterError."""
        check_extent(values)
        self._values = values
        self._lower = np.array([values["xmin"], values["ymin"]], float)  # (x, y), m, of the map
        self._upper = np.array([values["xmax"], values["ymax"]], float)
        self._seen = 0
        self.slam: ParticleSlam | None = None

    def is_wanted(self) -> bool:
        """Counts a scan; whether throttle_scans lets it through."""
        self._seen += 1
        return (self._seen - 1) % self._values["throttle_scans"] == 0

    def take(self, scan: LaserScan, odometry: np.ndarray, mount: Mount) -> bool:
        """True if the scan was used. `odometry` (x, y, yaw) of the robot at the scan's stamp.

        Raises ScanError, and then leaves everything unchanged, even if the scan was the first.
        """
        settings = (self.slam.settings if self.slam
                    else settings_from(self._values, scan.range_max))
        ranges = ranges_of(scan)
        extent = self._extent_with(_reach(ranges, settings) + np.hypot(*mount.pose[:2]), odometry)
        if self.slam is None:
            self.slam = ParticleSlam(settings, self._values["seed"])
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        used = self.slam.add(scan.header.stamp.to_sec(), odometry, ranges,
                             -angles if mount.upside_down else angles, mount.pose)
        if used:
            self._lower, self._upper = extent
        return used

    def _extent_with(self, reach: float, odometry: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bounds (lower, upper), each (x, y), m, of the map with this scan; raises ScanError."""
        x, y, _ = poses.compose(self.slam.map_to_odom, odometry) if self.slam else odometry
        lower = np.minimum(self._lower, (x - reach, y - reach))
        upper = np.maximum(self._upper, (x + reach, y + reach))
        with np.errstate(over="ignore", invalid="ignore"):
            about = (2.0 * np.float64(reach) / self._values["delta"]) ** 2
            cells = np.prod((upper - lower) / self._values["delta"])
        for name, found, most in (("it", about, LARGEST_SCAN), ("the map", cells, LARGEST)):
            if not found <= most:
                raise ScanError(f"a scan of {reach:g} m about ({x:g}, {y:g}) m is left out: {name} "
                                f"would have {found:.0e} cells, more than {most:.0e}; write a "
                                f"smaller ~maxUrange or a larger ~delta")
        return lower, upper


def _reach(ranges: np.ndarray, settings: SlamSettings) -> float:
    """The longest valid range, m, at most maxUrange."""
    with np.errstate(invalid="ignore"):
        told = ranges[(ranges <= settings.maxRange) & np.isfinite(ranges)]
    return min(told.max(initial=0.0), settings.maxUrange)

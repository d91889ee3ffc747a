"""libgazebo_ros_velodyne_laser.so and its GPU twin: a 3D lidar's sensor_msgs/PointCloud2."""

import math

import numpy as np
from sensor_msgs.msg import PointCloud2, PointField

from bullet_sim.sensors.laser import Laser
from bullet_sim_ros import params
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin

POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"),
                  ("ring", "<u2"), ("time", "<f4")])  # as velodyne_pointcloud lays points out
TYPES = {"<f4": PointField.FLOAT32, "<u2": PointField.UINT16}
FIELDS = [PointField(name, POINT.fields[name][1], TYPES[POINT.fields[name][0].str], 1)
          for name in POINT.names]


@plugin("libgazebo_ros_velodyne_laser.so", "libgazebo_ros_velodyne_gpu_laser.so")
class VelodynePlugin(SensorPlugin):
    """Points go column by column, the lowest ring first. A namespace other than / is the tf_prefix.

    Both see collision shapes; Gazebo's gpu_ray sensor sees visuals.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._laser = Laser(context.world, context.link, context.sensor)
        self._nearest = max(p.bound("min_range", 0.0), self._laser.ray.range_min)
        self._farthest = min(p.bound("max_range", math.inf), self._laser.ray.range_max)
        self._faintest = p.bound("min_intensity", -math.inf)
        self._organised = p.flag("organize_cloud", False)
        super().__init__(context, PointCloud2, p.topic("/points"), p.text("frameName", "/world"),
                         tf_prefix=_tf_prefix, noise=f"{context.sensor_name} points")
        self.publish_readings()

    def measure(self) -> PointCloud2:
        """One revolution."""
        points, seen = self._points()
        if not self._organised:
            points = points[seen][None]
        msg = PointCloud2(height=points.shape[0], width=points.shape[1], fields=FIELDS)
        msg.point_step, msg.row_step = POINT.itemsize, POINT.itemsize * points.shape[1]
        msg.is_dense = not self._organised
        msg.data = points.tobytes()
        return msg

    def _points(self) -> tuple[np.ndarray, np.ndarray]:
        """POINTs (columns, rings), NaN where a ray has none, and a mask of those that have one."""
        ranges, retro = self._laser.measure()
        seen = self._within(ranges) & (retro >= self._faintest)
        if self.noise:
            ranges = self.disturbed(ranges)
            seen &= self._within(ranges)
        points = np.zeros(ranges.shape, POINT)
        places = self._laser.fan.directions * np.where(seen, ranges, np.nan)[..., None]
        points["x"], points["y"], points["z"] = np.moveaxis(places, -1, 0)
        points["intensity"] = np.where(seen, retro, np.nan)
        points["ring"] = np.arange(len(ranges))[:, None]
        return points.T, seen.T

    def _within(self, ranges: np.ndarray) -> np.ndarray:
        return (self._nearest < ranges) & (ranges < self._farthest)


def _tf_prefix(namespace: str) -> str:
    return namespace if namespace != "/" else params.own_tf_prefix(namespace)

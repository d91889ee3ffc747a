"""libgazebo_ros_block_laser.so: the points that a fan of rays hits, as sensor_msgs/PointCloud."""

import numpy as np
from geometry_msgs.msg import Point32
from sensor_msgs.msg import ChannelFloat32, PointCloud

from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin


@plugin("libgazebo_ros_block_laser.so")
class BlockLaserPlugin(SensorPlugin):
    """Rays that hit nothing give points at range_max, without noise; `<ray>`'s noise is not used.

    Points lie where the rays went: gazebo_ros_block_laser.cpp, PutLaserData, mirrors them top to
    bottom, turns them by half a ray and gives NaN for a single row.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._fan = RayFan(context.world, context.link, context.sensor)
        super().__init__(context, PointCloud, p.topic("/world"), p.text("frameName", "/world"),
                         noise=f"{context.sensor_name} points")
        self.publish_readings()

    def measure(self) -> PointCloud:
        """One sweep; PutLaserData gives the channel no name."""
        distances, retro = self._fan.cast()
        points = self._fan.directions * distances[..., None]
        if self.noise:
            random = self.random()
            met = (distances < self._fan.ray.range_max)[..., None]
            points = points + random.normal(0.0, self.noise, points.shape) * met
            retro = retro + random.normal(0.0, self.noise, retro.shape)
        return PointCloud(points=[Point32(*point) for point in points.reshape(-1, 3).tolist()],
                          channels=[ChannelFloat32(values=np.ravel(retro).tolist())])

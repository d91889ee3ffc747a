"""Sensors of rays: laser, block laser (points), and range."""

import numpy as np
from geometry_msgs.msg import Point32
from sensor_msgs.msg import ChannelFloat32, LaserScan, PointCloud, Range

from bullet_sim.sensors.laser import Laser, RayFan
from bullet_sim_ros import convert, params
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin


@plugin("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")
class LaserPlugin(SensorPlugin):
    """The rate is the sensor's `<update_rate>`; the plugin has none.

    Both see collision shapes; Gazebo's gpu_ray sensor sees visuals.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._laser = Laser(context.world, context.link, context.sensor)
        super().__init__(context, LaserScan, p.topic("/world"), p.text("frameName", "/world"),
                         namespace=p.namespace(missing="/", empty=context.model.name),
                         tf_prefix=params.tf_prefix)
        self.publish_readings()

    def measure(self) -> LaserScan:
        """One sweep."""
        return convert.laser_to_msg(self._laser.sample())


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


@plugin("libgazebo_ros_range.so")
class RangePlugin(SensorPlugin):
    """The distance of the nearest hit of any ray. Any `radiation` but ultrasound is infrared."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._fan = RayFan(context.world, context.link, context.sensor)
        super().__init__(context, Range, p.topic("/range"), p.text("frameName", "/world"),
                         noise=f"{context.sensor_name} range")
        ultrasound = p.text("radiation", "ultrasound") == "ultrasound"
        self._radiation = Range.ULTRASOUND if ultrasound else Range.INFRARED
        self._field_of_view = p.number("fov", 0.05)
        self.publish_readings(p.number("updateRate", 0.0))

    def measure(self) -> Range:
        """The distance now, or range_max."""
        ray, distance = self._fan.ray, self._fan.nearest()
        if distance < ray.range_max:
            distance = min(float(self.disturbed(distance)), ray.range_max)
        return Range(radiation_type=self._radiation, field_of_view=self._field_of_view,
                     min_range=ray.range_min, max_range=ray.range_max, range=distance)

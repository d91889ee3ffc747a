"""libgazebo_ros_block_laser.so: the points that a fan of rays meets, as sensor_msgs/PointCloud."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Point32
from sensor_msgs.msg import ChannelFloat32, PointCloud

from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_block_laser.so")
class BlockLaserPlugin:
    """Rays that meet nothing give points at range_max, without noise; the ray's own is not used.

    Points lie where the rays went: upstream mirrors them top to bottom, turns them by half a ray
    and makes NaN of a single row.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._fan = RayFan(context.world, context.link, context.sensor)
        self._noise = p.deviation("gaussianNoise")
        self._name = f"{context.link.scoped_name}::{context.sensor.name} points"
        topic = p.topic("/world")
        if not topic:
            return
        namespace = p.namespace(missing="/", empty="/")
        self._frame = names.frame(params.own_tf_prefix(namespace), p.text("frameName", "/world"))
        self._clouds = context.advertise(names.join(namespace, topic), PointCloud, queue_size=1)
        context.every(context.sensor.update_rate, self._sweep, self._clouds.get_num_connections)

    def _sweep(self) -> None:
        distances, retro = self._fan.cast()
        points = self._fan.directions * distances[..., None]
        if self._noise:
            random = self._context.world.random(self._name)
            met = (distances < self._fan.ray.range_max)[..., None]
            points = points + random.normal(0.0, self._noise, points.shape) * met
            retro = retro + random.normal(0.0, self._noise, retro.shape)
        msg = PointCloud(points=[Point32(*point) for point in points.reshape(-1, 3).tolist()])
        msg.header.stamp, msg.header.frame_id = convert.stamp(self._context.world.time), self._frame
        msg.channels = [ChannelFloat32(values=np.ravel(retro).tolist())]  # upstream gives no name
        self._clouds.publish(msg)

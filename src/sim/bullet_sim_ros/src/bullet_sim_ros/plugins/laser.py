"""libgazebo_ros_laser.so and its GPU twin: LaserScan while somebody listens."""

from __future__ import annotations

from sensor_msgs.msg import LaserScan

from bullet_sim.sensors.laser import Laser
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_laser.so", "libgazebo_ros_gpu_laser.so")
class LaserPlugin:
    """The rate is the sensor's `<update_rate>`; the plugin has none.

    Both see collision shapes (upstream's GPU twin sees visuals).
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._laser = Laser(context.world, context.link, context.sensor)
        topic = p.topic("/world")
        if not topic:
            return
        namespace = p.namespace(missing="/", empty=context.model.name)
        self._frame = names.frame(params.tf_prefix(namespace), p.text("frameName", "/world"))
        self._scans = context.advertise(names.join(namespace, topic), LaserScan, queue_size=1)
        context.every(context.sensor.update_rate, self._sweep, self._scans.get_num_connections)

    def _sweep(self) -> None:
        self._scans.publish(convert.laser_to_msg(self._laser.sample(), self._frame))

"""libgazebo_ros_range.so: sonar and infrared range finders, sensor_msgs/Range."""

from __future__ import annotations

from sensor_msgs.msg import Range

from bullet_sim.sensors.range_finder import RangeFinder
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin


@plugin("libgazebo_ros_range.so")
class RangePlugin:
    """The nearest thing that any ray meets. Any `radiation` but ultrasound is infrared."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._finder = RangeFinder(context.world, context.link, context.sensor)
        self._noise = p.deviation("gaussianNoise")
        self._name = f"{context.link.scoped_name}::{context.sensor.name} range"
        topic = p.topic("/range")
        if not topic:
            return
        namespace = p.namespace(missing="/", empty="/")
        self._frame = names.frame(params.own_tf_prefix(namespace), p.text("frameName", "/world"))
        ultrasound = p.text("radiation", "ultrasound") == "ultrasound"
        self._radiation = Range.ULTRASOUND if ultrasound else Range.INFRARED
        self._field_of_view = p.number("fov", 0.05)
        self._ranges = context.advertise(names.join(namespace, topic), Range, queue_size=1)
        context.every_reading(p.number("updateRate", 0.0), self._measure,
                              self._ranges.get_num_connections)

    def _measure(self) -> None:
        ray, world = self._finder.ray, self._context.world
        distance = self._finder.sample()
        if self._noise and distance < ray.range_max:
            disturbed = distance + world.random(self._name).normal(0.0, self._noise)
            distance = min(disturbed, ray.range_max)
        msg = Range(radiation_type=self._radiation, field_of_view=self._field_of_view,
                    min_range=ray.range_min, max_range=ray.range_max, range=distance)
        msg.header.stamp, msg.header.frame_id = convert.stamp(world.time), self._frame
        self._ranges.publish(msg)

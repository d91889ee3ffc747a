"""libhector_gazebo_ros_sonar.so: sensor_msgs/Range of a ray sensor."""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import Range

from bullet_sim.sensors.range_finder import RangeFinder
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.hector import common


@plugin("libhector_gazebo_ros_sonar.so")
class HectorSonarPlugin:
    """Rate 10 Hz unless told, whatever the sensor's; what is nearer than range_max has errors."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        self._finder = RangeFinder(context.world, context.link, context.sensor)
        self._error = common.HectorError(context, f"{context.link.name} {context.sensor.name}", 1)
        self._stopwatch = common.Stopwatch(context)
        self._frame = names.frame("", p.text("frameId", "/sonar_link"))
        topic = common.topic_of(context, "sonar")
        self._ranges = context.advertise(topic, Range, queue_size=1)
        self._error.offer(topic)
        context.every(common.update_rate(p, 10.0), self._measure, self._wanted)

    def _wanted(self) -> bool:
        """A drift goes on whether or not anybody listens."""
        return self._error.drifts or bool(self._ranges.get_num_connections())

    def _measure(self) -> None:
        ray, elapsed = self._finder.ray, self._stopwatch.lap()
        true = self._finder.sample()
        told = float(self._error.apply(np.array([true]), elapsed)[0])
        if true < ray.range_max:
            true = min(max(told, ray.range_min), ray.range_max)
        msg = Range(radiation_type=Range.ULTRASOUND, min_range=ray.range_min,
                    max_range=ray.range_max, range=true)
        msg.field_of_view = min(abs(ray.max_angle - ray.min_angle),
                                abs(ray.vertical_max_angle - ray.vertical_min_angle))
        msg.header.stamp, msg.header.frame_id = convert.stamp(self._context.world.time), self._frame
        self._ranges.publish(msg)

"""libhector_gazebo_ros_sonar.so: sensor_msgs/Range of a ray sensor."""

import numpy as np
from sensor_msgs.msg import Range

from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common


@plugin("libhector_gazebo_ros_sonar.so")
class HectorSonarPlugin(common.HectorSensor):
    """10 Hz by default, whatever the sensor's rate; distances below range_max have errors."""

    def __init__(self, context: PluginContext):
        self._fan = RayFan(context.world, context.link, context.sensor)
        super().__init__(context, Range, "sonar", "/sonar_link", queue_size=1)
        self._error = self.add_error(f"{context.link.name} {context.sensor.name}", 1)
        self.offer(self._error)
        self.begin(10.0)

    def measure(self) -> Range:
        """The distance now, or range_max."""
        ray, distance = self._fan.ray, self._fan.nearest()
        measured = float(self._error.apply(np.array([distance]), self.elapsed())[0])
        if distance < ray.range_max:
            distance = min(max(measured, ray.range_min), ray.range_max)
        return Range(
            radiation_type=Range.ULTRASOUND, min_range=ray.range_min, max_range=ray.range_max,
            field_of_view=min(abs(ray.max_angle - ray.min_angle),
                              abs(ray.vertical_max_angle - ray.vertical_min_angle)),
            range=distance)

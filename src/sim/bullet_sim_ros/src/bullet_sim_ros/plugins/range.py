"""libgazebo_ros_range.so: sonar and infrared range finders, sensor_msgs/Range."""

from sensor_msgs.msg import Range

from bullet_sim.sensors.ray_fan import RayFan
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, plugin


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

"""libgazebo_ros_laser.so and its GPU twin: LaserScan while somebody listens."""

from sensor_msgs.msg import LaserScan

from bullet_sim.sensors.laser import Laser
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

"""libhector_gazebo_ros_baro.so: height by air pressure."""

import numpy as np
from geometry_msgs.msg import Point, PointStamped
from hector_uav_msgs.msg import Altimeter

from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common

# International barometric formula: pressure = qnh (1 - altitude / SCALE)^EXPONENT
SCALE, EXPONENT = 44330.0, 5.263157  # m; 1: 1 / 0.19, rounded as in gazebo_ros_baro.cpp, Update


@plugin("libhector_gazebo_ros_baro.so")
class HectorBaroPlugin(common.HectorSensor):
    """Height over the world's z = 0 as a point, and pressure (in the unit of `qnh`, hPa)."""

    def __init__(self, context: PluginContext):
        p, self._link = context.parameters, common.find_link(context)
        super().__init__(context, PointStamped, "pressure_height", self._link.name)
        self._elevation, self._qnh = p.number("elevation", 0.0), p.number("qnh", 1013.25)
        self._error = self.add_error("height", 1)
        topic = p.topic("altimeter", "altimeterTopicName")
        self._altimeters = self.advertise(Altimeter, topic, queue_size=10)
        if self._altimeters:
            common.offer_errors(context, self._error, self._altimeters.name)
        self.begin(0.0)

    def measure(self) -> PointStamped:
        """The height now; publishes the pressure, too."""
        true = self._link.pose.position[2]
        height = float(self._error.apply(np.array([true]), self.elapsed())[0])
        if self._altimeters:
            altitude = height + self._elevation
            pressure = max(0.0, 1.0 - altitude / SCALE) ** EXPONENT * self._qnh
            self._altimeters.publish(self.stamped(
                Altimeter(altitude=altitude, pressure=pressure, qnh=self._qnh)))
        return PointStamped(point=Point(z=height))

"""libhector_gazebo_ros_baro.so: height by air pressure."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PointStamped
from hector_uav_msgs.msg import Altimeter

from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.hector import common

# International barometric formula: pressure = qnh (1 - altitude / SCALE)^EXPONENT
SCALE, EXPONENT = 44330.0, 5.263157  # m; 1, as upstream rounds 1 / 0.19


@plugin("libhector_gazebo_ros_baro.so")
class HectorBaroPlugin:
    """Height over the world's z = 0 as a point, and pressure (in the unit of `qnh`, hPa)."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context, self._link = context, common.find_link(context)
        self._frame = names.frame("", p.text("frameId", self._link.name))
        self._elevation, self._qnh = p.number("elevation", 0.0), p.number("qnh", 1013.25)
        self._error = common.HectorError(context, "height", 1)
        self._stopwatch = common.Stopwatch(context)
        height = common.topic_of(context, "pressure_height")
        altimeter = common.topic_of(context, "altimeter", "altimeterTopicName")
        self._heights = context.advertise(height, PointStamped, queue_size=10) if height else None
        self._altimeters = None
        if altimeter:
            self._altimeters = context.advertise(altimeter, Altimeter, queue_size=10)
            self._error.offer(altimeter)
        context.every(common.update_rate(p, 0.0), self._measure, self._wanted)

    def _wanted(self) -> bool:
        """A drift goes on whether or not anybody listens."""
        return self._error.drifts or any(
            publisher.get_num_connections() for publisher in (self._heights, self._altimeters)
            if publisher)

    def _measure(self) -> None:
        true = self._link.pose.position[2]
        height = float(self._error.apply(np.array([true]), self._stopwatch.lap())[0])
        point = PointStamped()
        point.header.stamp = convert.stamp(self._context.world.time)
        point.header.frame_id = self._frame
        point.point.z = height
        if self._heights:
            self._heights.publish(point)
        if self._altimeters:
            altitude = height + self._elevation
            pressure = max(0.0, 1.0 - altitude / SCALE) ** EXPONENT * self._qnh
            self._altimeters.publish(Altimeter(point.header, altitude, pressure, self._qnh))

"""libhector_gazebo_ros_magnetic.so: the Earth's magnetic field in the axes of a link."""

from __future__ import annotations

import math

import numpy as np
from geometry_msgs.msg import Vector3, Vector3Stamped
from sensor_msgs.msg import MagneticField

from bullet_sim.pose import conjugate, rotate
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.hector import common
from bullet_sim_ros.plugins.hector.gps import world_heading


@plugin("libhector_gazebo_ros_magnetic.so")
class HectorMagneticPlugin:
    """Of length `magnitude`, `inclination` below level, `declination` clockwise from true north.

    The world's `<magnetic_field>` is not used in upstream either; its heading is, as by the GPS.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context, self._link = context, common.find_link(context)
        self._frame = names.frame("", p.text("frameId", self._link.name))
        self._field = self._read_field()
        self._error = common.HectorError(context, "field", 3)
        self._stopwatch = common.Stopwatch(context)
        self._kind = MagneticField if p.flag("useMagneticFieldMsgs", False) else Vector3Stamped
        topic = common.topic_of(context, "magnetic")
        self._fields = context.advertise(topic, self._kind, queue_size=1)
        self._error.offer(topic)
        context.every(common.update_rate(p, 0.0), self._measure, self._wanted)

    def _read_field(self) -> np.ndarray:
        """In the world's axes, (3,)."""
        p, spherical = self._context.parameters, self._context.world.description.spherical
        heading = 0.0
        if spherical and p.flag("useWorldSphericalCoordinates", True):
            heading = world_heading(spherical)
        heading = math.radians(p.number("referenceHeading", math.degrees(heading)))
        dip = math.radians(p.number("inclination", 60.0))
        turn = heading - math.radians(p.number("declination", 0.0))
        return p.number("magnitude", 1.0) * np.array(
            [math.cos(dip) * math.cos(turn), math.cos(dip) * math.sin(turn), -math.sin(dip)])

    def _wanted(self) -> bool:
        """A drift goes on whether or not anybody listens."""
        return self._error.drifts or bool(self._fields.get_num_connections())

    def _measure(self) -> None:
        true = rotate(conjugate(self._link.pose.orientation), self._field)
        field = Vector3(*self._error.apply(np.array(true), self._stopwatch.lap()).tolist())
        if self._kind is MagneticField:
            msg = MagneticField(magnetic_field=field)
        else:
            msg = Vector3Stamped(vector=field)
        msg.header.stamp, msg.header.frame_id = convert.stamp(self._context.world.time), self._frame
        self._fields.publish(msg)

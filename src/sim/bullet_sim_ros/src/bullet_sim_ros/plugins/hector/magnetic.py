"""libhector_gazebo_ros_magnetic.so: the Earth's magnetic field in the axes of a link."""

import math

import numpy as np
from geometry_msgs.msg import Vector3, Vector3Stamped
from sensor_msgs.msg import MagneticField

from bullet_sim.pose import conjugate, rotate
from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common
from bullet_sim_ros.plugins.hector.gps import world_heading


@plugin("libhector_gazebo_ros_magnetic.so")
class HectorMagneticPlugin(common.HectorSensor):
    """A field of `magnitude`, `inclination` below level, `declination` clockwise from true north.

    The world's `<magnetic_field>` is not used, as in gazebo_ros_magnetic.cpp, Load; its heading is,
    as by the GPS.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._link = common.find_link(context)
        self._kind = MagneticField if p.flag("useMagneticFieldMsgs", False) else Vector3Stamped
        super().__init__(context, self._kind, "magnetic", self._link.name, queue_size=1)
        self._field = self._read_field()
        self._error = self.add_error("field", 3)
        self.offer(self._error)
        self.begin(0.0)

    def _read_field(self) -> np.ndarray:
        """The field in the world's axes, (3,)."""
        p, spherical = self.context.parameters, self.world.description.spherical
        heading = 0.0
        if spherical and p.flag("useWorldSphericalCoordinates", True):
            heading = world_heading(spherical)
        heading = math.radians(p.number("referenceHeading", math.degrees(heading)))
        dip = math.radians(p.number("inclination", 60.0))
        turn = heading - math.radians(p.number("declination", 0.0))
        return p.number("magnitude", 1.0) * np.array(
            [math.cos(dip) * math.cos(turn), math.cos(dip) * math.sin(turn), -math.sin(dip)])

    def measure(self) -> MagneticField | Vector3Stamped:
        """The field now."""
        true = rotate(conjugate(self._link.pose.orientation), self._field)
        field = Vector3(*self._error.apply(np.array(true), self.elapsed()).tolist())
        if self._kind is MagneticField:
            return MagneticField(magnetic_field=field)
        return Vector3Stamped(vector=field)

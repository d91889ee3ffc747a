"""libhector_gazebo_ros_baro.so, _gps.so, _magnetic.so and _sonar.so."""

import math

import numpy as np
from geometry_msgs.msg import Point, PointStamped, Vector3, Vector3Stamped
from hector_uav_msgs.msg import Altimeter
from sensor_msgs.msg import MagneticField, NavSatFix, NavSatStatus, Range

from bullet_sim.description import SphericalDescription
from bullet_sim.pose import conjugate, rotate
from bullet_sim.sensors.geo_reference import GeoReference
from bullet_sim.sensors.laser import RayFan
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common
from bullet_sim_ros.reconfigure_server import Value, offer_changes

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


DARMSTADT = (49.9, 8.9)  # degrees, the default reference of gazebo_ros_gps.cpp
SERVICES = {"SERVICE_GPS": NavSatStatus.SERVICE_GPS,
            "SERVICE_GLONASS": NavSatStatus.SERVICE_GLONASS,
            "SERVICE_COMPASS": NavSatStatus.SERVICE_COMPASS,
            "SERVICE_GALILEO": NavSatStatus.SERVICE_GALILEO}
FIXES = {"STATUS_SBAS_FIX": NavSatStatus.STATUS_SBAS_FIX,
         "STATUS_GBAS_FIX": NavSatStatus.STATUS_GBAS_FIX}


def world_heading(spherical: SphericalDescription) -> float:
    """Compass direction, rad from north, of the x axis of a world that was placed on Earth."""
    return math.pi / 2 - math.radians(spherical.heading_deg)


@plugin("libhector_gazebo_ros_gps.so")
class HectorGpsPlugin(common.HectorSensor):
    """The world's `<spherical_coordinates>` count unless `useWorldSphericalCoordinates` is false.

    Releases of gazebo_ros_gps.cpp, Load, differ in that. A drift of the velocity also moves the
    position.
    """

    def __init__(self, context: PluginContext):
        p, self._link = context.parameters, common.find_link(context)
        super().__init__(context, NavSatFix, "fix", "/world")
        self._reference = self._read_reference()
        self._position = self.add_error("position", 3)
        self._velocity = self.add_error("velocity", 3, "velocity")
        self._status = NavSatStatus(status=int(p.number("status", NavSatStatus.STATUS_FIX)),
                                    service=int(p.number("service", 0)))
        self._velocities = self.advertise(
            Vector3Stamped, p.topic("fix_velocity", "velocityTopicName"), queue_size=10)
        self.offer(self._position, "position")
        self.offer(self._velocity, "velocity")
        self._offer_status(names.join(names.join(self.namespace, self.topic), "status"))
        self.begin(4.0)

    def _read_reference(self) -> GeoReference:
        p, spherical = self.context.parameters, self.world.description.spherical
        place = (*DARMSTADT, 0.0, 0.0)
        if p.flag("useWorldSphericalCoordinates", spherical is not None):
            spherical = spherical or SphericalDescription()
            place = (spherical.latitude_deg, spherical.longitude_deg, spherical.elevation,
                     world_heading(spherical))
        heading = p.number("referenceHeading", math.degrees(place[3]))
        return GeoReference(p.number("referenceLatitude", place[0]),
                            p.number("referenceLongitude", place[1]),
                            p.number("referenceAltitude", place[2]), math.radians(heading))

    def _offer_status(self, namespace: str) -> None:
        usual = {"STATUS_FIX": True, **dict.fromkeys(FIXES, False), **dict.fromkeys(SERVICES, True)}
        offer_changes(self.context, namespace, {
            name: Value(now, False, True, name) for name, now in usual.items()}, self._set_status)

    def _set_status(self, values: dict[str, bool]) -> None:
        fix = sum(FIXES[name] for name in FIXES if values[name])
        self._status.status = fix if values["STATUS_FIX"] else NavSatStatus.STATUS_NO_FIX
        self._status.service = sum(SERVICES[name] for name in SERVICES if values[name])

    def measure(self) -> NavSatFix:
        """The position now; publishes the velocity, too."""
        elapsed, place = self.elapsed(), self._reference
        velocity = self._velocity.apply(np.array(self._link.twist.linear), elapsed)
        position = self._position.apply(np.array(self._link.pose.position), elapsed)
        self._position.set_drift(self._position.drift + elapsed * self._velocity.drift)
        if self._velocities:
            moving = Vector3(*place.north_west_up(tuple(velocity.tolist())))
            self._velocities.publish(self.stamped(Vector3Stamped(vector=moving)))
        latitude, longitude, altitude = place.geodetic(tuple(position.tolist()))
        errors = self._position.parameters
        variances = np.square(errors.drift) + np.square(errors.gaussian_noise)
        return NavSatFix(status=self._status, latitude=latitude, longitude=longitude,
                         altitude=altitude, position_covariance=convert.diagonal(variances),
                         position_covariance_type=NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN)


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

"""libhector_gazebo_ros_gps.so: sensor_msgs/NavSatFix and the velocity north, west, up."""

import math

import numpy as np
from geometry_msgs.msg import Vector3, Vector3Stamped
from sensor_msgs.msg import NavSatFix, NavSatStatus

from bullet_sim.description import SphericalDescription
from bullet_sim.sensors.geo_reference import GeoReference
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext, plugin
from bullet_sim_ros.plugins.hector import common
from bullet_sim_ros.reconfigure_server import Value, offer_changes

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

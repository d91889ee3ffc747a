"""libhector_gazebo_ros_gps.so: sensor_msgs/NavSatFix and the velocity north, west, up."""

from __future__ import annotations

import math

import numpy as np
from geometry_msgs.msg import Vector3, Vector3Stamped
from sensor_msgs.msg import NavSatFix, NavSatStatus

from bullet_sim.description import SphericalDescription
from bullet_sim.sensors.gps import GeoReference
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import plugin
from bullet_sim_ros.plugins.hector import common
from bullet_sim_ros.reconfigure_server import Value, offer_values

DARMSTADT = (49.9, 8.9)  # degrees, upstream's place where nobody names one
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
class HectorGpsPlugin:
    """The world's `<spherical_coordinates>` count unless `useWorldSphericalCoordinates` is false.

    Releases of upstream differ there. A drift of the velocity moves the position, too.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context, self._link = context, common.find_link(context)
        self._frame = names.frame("", p.text("frameId", "/world"))
        self._reference = self._read_reference()
        self._position = common.HectorError(context, "position", 3)
        self._velocity = common.HectorError(context, "velocity", 3, "velocity")
        self._stopwatch = common.Stopwatch(context)
        self._status = NavSatStatus(status=int(p.number("status", NavSatStatus.STATUS_FIX)),
                                    service=int(p.number("service", 0)))
        fix, velocity = (common.topic_of(context, "fix"),
                         common.topic_of(context, "fix_velocity", "velocityTopicName"))
        self._fixes = context.advertise(fix, NavSatFix, queue_size=10)
        self._velocities = context.advertise(velocity, Vector3Stamped, queue_size=10)
        self._position.offer(f"{fix}/position")
        self._velocity.offer(f"{fix}/velocity")
        self._offer_status(f"{fix}/status")
        context.every(common.update_rate(p, 4.0), self._measure, self._wanted)

    def _read_reference(self) -> GeoReference:
        p, spherical = self._context.parameters, self._context.world.description.spherical
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
        known: list[bool] = []

        def change(values: dict[str, bool]) -> None:
            if known:  # the first call only tells what there is
                self._context.services.mailbox.post(lambda: self._set_status(values))
            known.append(True)

        usual = {"STATUS_FIX": True, **dict.fromkeys(FIXES, False), **dict.fromkeys(SERVICES, True)}
        offer_values(self._context, namespace, {
            name: Value(now, False, True, name) for name, now in usual.items()}, change)

    def _set_status(self, values: dict[str, bool]) -> None:
        fix = sum(FIXES[name] for name in FIXES if values[name])
        self._status.status = fix if values["STATUS_FIX"] else NavSatStatus.STATUS_NO_FIX
        self._status.service = sum(SERVICES[name] for name in SERVICES if values[name])

    def _wanted(self) -> bool:
        """A drift goes on whether or not anybody listens."""
        return (self._position.drifts or self._velocity.drifts
                or bool(self._fixes.get_num_connections())
                or bool(self._velocities.get_num_connections()))

    def _measure(self) -> None:
        elapsed, place = self._stopwatch.lap(), self._reference
        velocity = self._velocity.apply(np.array(self._link.twist.linear), elapsed)
        position = self._position.apply(np.array(self._link.pose.position), elapsed)
        self._position.set_drift(self._position.drift + elapsed * self._velocity.drift)
        fix = NavSatFix(status=self._status)
        fix.header.stamp = convert.stamp(self._context.world.time)
        fix.header.frame_id = self._frame
        fix.latitude, fix.longitude, fix.altitude = place.geodetic(tuple(position.tolist()))
        errors = self._position.parameters
        variances = np.square(errors.drift) + np.square(errors.gaussian_noise)
        fix.position_covariance = np.diag(variances).ravel().tolist()
        fix.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
        moving = Vector3Stamped(header=fix.header)
        moving.vector = Vector3(*place.north_west_up(tuple(velocity.tolist())))
        self._fixes.publish(fix)
        self._velocities.publish(moving)

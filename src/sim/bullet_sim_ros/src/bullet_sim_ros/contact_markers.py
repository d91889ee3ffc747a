"""Contacts as markers that rviz can show: a ball where things touch, an arrow for the force."""

import math

import rospy
from gazebo_msgs.msg import ContactsState
from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

BALL = 0.03  # m, diameter
METRES_PER_NEWTON = 0.02
LONGEST = 0.5  # m, of an arrow
LIFETIME = rospy.Duration(0.3)  # s; DELETEALL would take other bumpers' markers with it
COLOUR = ColorRGBA(1.0, 0.0, 1.0, 1.0)  # a colour that no robot, laser or path here has


def to_markers(contacts: ContactsState, namespace: str) -> MarkerArray:
    """All markers of one message; they expire by themselves when no more messages follow."""
    markers: list[Marker] = []
    for state in contacts.states:
        for point, normal, wrench in zip(state.contact_positions, state.contact_normals,
                                         state.wrenches, strict=False):
            force = math.hypot(wrench.force.x, wrench.force.y, wrench.force.z)  # N
            markers.append(_ball(contacts.header, namespace, len(markers), point))
            markers.append(_arrow(contacts.header, namespace, len(markers), point, normal, force))
    return MarkerArray(markers)


def _marker(header: Header, namespace: str, number: int, kind: int) -> Marker:
    marker = Marker(header=header, ns=namespace, id=number, type=kind, color=COLOUR)
    marker.pose.orientation.w = 1.0
    marker.lifetime = LIFETIME
    return marker


def _ball(header: Header, namespace: str, number: int, at: Vector3) -> Marker:
    marker = _marker(header, namespace, number, Marker.SPHERE)
    marker.pose.position = Point(at.x, at.y, at.z)
    marker.scale = Vector3(BALL, BALL, BALL)
    return marker


def _arrow(header: Header, namespace: str, number: int, at: Vector3, normal: Vector3,
           force: float) -> Marker:
    marker = _marker(header, namespace, number, Marker.ARROW)
    length = min(force * METRES_PER_NEWTON, LONGEST)
    tip = Point(at.x + length * normal.x, at.y + length * normal.y, at.z + length * normal.z)
    marker.points = [Point(at.x, at.y, at.z), tip]
    marker.scale = Vector3(BALL / 3, BALL * 2 / 3, 0.0)  # diameters of shaft and head
    return marker

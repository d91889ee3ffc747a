"""Messages for the tab RViz, made up so that what is to be drawn can be counted."""

from __future__ import annotations

import math

import numpy as np
import rospy
from geometry_msgs.msg import (
    Point,
    Point32,
    PolygonStamped,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
)
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from sensor_msgs.msg import CameraInfo, Image, LaserScan, PointCloud2, PointField, Range
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

BEAMS, HITS = 360, 300
MAP = (80, 60)  # cells
CLOUD = 1_000_000  # points
URDF = """<robot name="box"><link name="base_link"><visual><origin xyz="0 0 0.1"/><geometry>
<box size="0.4 0.3 0.2"/></geometry><material name="blue"><color rgba="0.1 0.3 0.9 1"/></material>
</visual></link></robot>"""


def turned(yaw: float) -> Quaternion:
    return Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def at(x: float, y: float, yaw: float = 0.0, z: float = 0.0) -> Pose:
    return Pose(Point(x, y, z), turned(yaw))


def transforms() -> list[TransformStamped]:
    """map, odom, base_link and laser, at rest."""
    found = []
    for parent, child, place, yaw in (("map", "odom", (0.5, 0.0, 0.0), 0.0),
                                      ("odom", "base_link", (0.5, 0.5, 0.0), math.pi / 2),
                                      ("base_link", "laser", (0.1, 0.0, 0.25), 0.0)):
        one = TransformStamped(Header(stamp=rospy.Time.now(), frame_id=parent), child, None)
        one.transform.translation, one.transform.rotation = Vector3(*place), turned(yaw)
        found.append(one)
    return found


def scan(frame: str = "laser") -> LaserScan:
    """A square room; the last beams hit nothing."""
    message = LaserScan(Header(frame_id=frame), -math.pi, math.pi, 2 * math.pi / BEAMS, 0.0, 0.1,
                        0.1, 10.0, [], [])
    angles = message.angle_min + np.arange(BEAMS) * message.angle_increment
    ranges = 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    ranges[HITS:] = math.inf
    message.ranges = ranges.tolist()
    return message


def grid() -> OccupancyGrid:
    """Walls round a free room with an unknown corner."""
    cells = np.zeros(MAP[::-1], np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    cells[:15, 60:] = -1
    message = OccupancyGrid(Header(frame_id="map"), None, cells.ravel().tolist())
    message.info.width, message.info.height, message.info.resolution = *MAP, 0.1
    message.info.origin = at(-3.0, -2.5)
    return message


def path() -> Path:
    places = [(1.0 + math.sin(a), 0.5 - a / 2) for a in np.linspace(0.0, 4.0, 50)]
    return Path(Header(frame_id="map"), [PoseStamped(Header(), at(*place)) for place in places])


def particles() -> PoseArray:
    chance = np.random.default_rng(0)
    return PoseArray(Header(frame_id="map"), [
        at(1.0 + x, 0.5 + y, yaw) for x, y, yaw in chance.normal(0.0, 0.2, (40, 3))])


def estimate() -> PoseWithCovarianceStamped:
    message = PoseWithCovarianceStamped(Header(frame_id="map"), None)
    message.pose.pose = at(1.0, 0.5, math.pi / 2)
    message.pose.covariance[0], message.pose.covariance[7] = 0.09, 0.04
    message.pose.covariance[35] = 0.07
    return message


def footprint() -> PolygonStamped:
    message = PolygonStamped(Header(frame_id="base_link"), None)
    message.polygon.points = [Point32(x, y, 0.0) for x, y in ((-.25, -.2), (.25, -.2), (.25, .2),
                                                             (-.25, .2))]
    return message


def sonar() -> Range:
    return Range(Header(frame_id="laser"), Range.ULTRASOUND, 0.5, 0.1, 3.0, 1.2)


def picture() -> Image:
    return Image(Header(), 48, 64, "rgb8", 0, 3 * 64, bytes((0, 128, 255)) * 48 * 64)


def camera_info() -> CameraInfo:
    """90 degrees wide; what is straight ahead is a quarter from the left, a half from above."""
    message = CameraInfo(header=Header(frame_id="eye"), height=48, width=64)
    message.P = [32.0, 0.0, 16.0, 0.0, 0.0, 32.0, 24.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    return message


def view_from_above() -> Image:
    message = picture()
    message.header.frame_id = "eye"
    return message


def eye() -> TransformStamped:
    """2 m above the marker of `marker`, looking down, in the axes of a camera's optical frame."""
    one = TransformStamped(Header(frame_id="map"), "eye", None)
    one.transform.translation = Vector3(-2.0, 2.0, 2.0)
    one.transform.rotation = Quaternion(1.0, 0.0, 0.0, 0.0)
    return one


def cloud(points: int = CLOUD) -> PointCloud2:
    """A wave, 2 m wide."""
    table = np.zeros((points, 3), np.float32)
    table[:, 0] = np.arange(points) % 1000 / 500 - 4.0
    table[:, 1] = np.arange(points) // 1000 / max(points // 1000, 1) * 2
    table[:, 2] = 0.5 + 0.3 * np.sin(4 * table[:, 0])
    fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate("xyz")]
    return PointCloud2(Header(frame_id="map"), 1, points, fields, False, 12, 12 * points,
                       table.tobytes(), True)


def odometry() -> Odometry:
    message = Odometry(header=Header(frame_id="odom"))
    message.pose.pose = at(-1.0, 1.0, 0.5)
    return message


def update() -> OccupancyGridUpdate:
    """A cell of 50 at column 10 of row 20."""
    return OccupancyGridUpdate(Header(frame_id="map"), 10, 20, 1, 1, [50])


def marker() -> Marker:
    return Marker(header=Header(frame_id="map"), ns="one", pose=at(-2.0, 2.0), type=Marker.SPHERE,
                  scale=Vector3(0.4, 0.4, 0.4), color=ColorRGBA(1.0, 0.6, 0.0, 0.5))


def markers() -> MarkerArray:
    """One of each type, in a row."""
    corners = [Point(0, 0, 0), Point(0.3, 0, 0), Point(0.3, 0.3, 0.2), Point(0, 0.3, 0.2)]
    found = MarkerArray()
    for kind in range(12):
        one = Marker(header=Header(frame_id="map"), ns="types", id=kind, type=kind,
                     pose=at(-3.0 + 0.6 * kind, -3.2, 0.4, 0.2), scale=Vector3(0.3, 0.3, 0.3),
                     color=ColorRGBA(kind / 11, 1 - kind / 11, 0.6, 1.0), text="hello 你好")
        if kind in (Marker.LINE_STRIP, Marker.LINE_LIST, Marker.POINTS):
            one.scale = Vector3(0.05, 0.05, 0.05)
        if kind in (Marker.CUBE_LIST, Marker.SPHERE_LIST):
            one.scale = Vector3(0.1, 0.1, 0.1)
        if kind in (Marker.LINE_STRIP, Marker.LINE_LIST, Marker.CUBE_LIST, Marker.SPHERE_LIST,
                    Marker.POINTS):
            one.points = corners
        if kind == Marker.TRIANGLE_LIST:
            one.points, one.scale = corners[:3], Vector3(1, 1, 1)
        if kind == Marker.MESH_RESOURCE:
            one.mesh_resource = "package://urdf01_rviz/meshes/autolabor_mini.stl"
            one.scale = Vector3(1, 1, 1)
        found.markers.append(one)
    return found

"""Conversion between the core's readings and ROS messages: pure functions, nothing is published."""

import math
from collections.abc import Sequence
from typing import Any, TypeVar

import cv2
import genpy
import numpy as np
import rospy
from geometry_msgs.msg import Point, TransformStamped, Vector3
from geometry_msgs.msg import Pose as PoseMsg
from geometry_msgs.msg import Quaternion as QuaternionMsg
from geometry_msgs.msg import Twist as TwistMsg
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Imu, JointState, LaserScan

from bullet_sim.description import CameraDescription
from bullet_sim.pose import Pose, Quaternion, normalised
from bullet_sim.rendering.frame import STRIP, strips
from bullet_sim.sensors.joint_states import JointReading
from bullet_sim.sensors.laser import LaserReading
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.twist import Twist
from bullet_sim_ros.array_messages import ArrayImage, ArrayPointCloud2
from bullet_sim_ros.cameras.encodings import encode

Message = TypeVar("Message")  # with a header
UNKNOWN_VARIANCE = 1e12
# m, m/s or rad/s; much larger numbers become NaN in the engine, and a body never recovers from it.
LARGEST = 1e6


def stamp(seconds: float) -> rospy.Time:
    """Simulated seconds to the nearest nanosecond (rospy.Time.from_sec truncates)."""
    return rospy.Time(0, round(seconds * 1e9))


def stamped(message: Message, time: float, frame: str = "") -> Message:
    """The message with its header filled in: simulated time (s) and frame."""
    message.header.stamp, message.header.frame_id = stamp(time), frame
    return message


def diagonal(values: Sequence[float]) -> list[float]:
    """A matrix with these values on its diagonal and zeros elsewhere, row by row."""
    return np.diag(values).ravel().tolist()


def pose_to_msg(pose: Pose) -> PoseMsg:
    """geometry_msgs/Pose."""
    return PoseMsg(Point(*pose.position), QuaternionMsg(*pose.orientation))


def pose_from_msg(msg: PoseMsg) -> Pose:
    """A pose with a unit quaternion; (0, 0, 0, 0) becomes no rotation."""
    return Pose(triple(msg.position), quaternion_from_msg(msg.orientation))


def quaternion_from_msg(msg: QuaternionMsg) -> Quaternion:
    """A unit quaternion; (0, 0, 0, 0) becomes no rotation."""
    return normalised((msg.x, msg.y, msg.z, msg.w))


def twist_to_msg(twist: Twist) -> TwistMsg:
    """geometry_msgs/Twist."""
    return TwistMsg(Vector3(*twist.linear), Vector3(*twist.angular))


def twist_from_msg(msg: TwistMsg) -> Twist:
    """The core's twist."""
    return Twist(triple(msg.linear), triple(msg.angular))


def triple(msg: Vector3 | Point) -> tuple[float, float, float]:
    """x, y and z."""
    return (msg.x, msg.y, msg.z)


def is_sane(*values: Any) -> bool:
    """Whether every number of messages, sequences and numbers is finite, up to LARGEST."""
    return all(abs(number) <= LARGEST for value in values for number in _numbers(value))


def _numbers(value: Any) -> list[float]:
    if isinstance(value, int | float):
        return [value]
    parts = [getattr(value, slot) for slot in value.__slots__] if isinstance(
        value, genpy.Message) else value
    return [number for part in parts for number in _numbers(part)]


def transform_to_msg(pose: Pose, time: float, parent: str, child: str) -> TransformStamped:
    """The transform from `parent` to `child`, whose pose in `parent` is given; time in s."""
    msg = stamped(TransformStamped(child_frame_id=child), time, parent)
    msg.transform.translation = Vector3(*pose.position)
    msg.transform.rotation = QuaternionMsg(*pose.orientation)
    return msg


def odometry_to_msg(reading: OdometryReading, frame: str, child: str) -> Odometry:
    """nav_msgs/Odometry, with the covariance of the pose that gazebo_ros_diff_drive gives."""
    msg = stamped(Odometry(child_frame_id=child), reading.time, frame)
    msg.pose.pose = pose_to_msg(reading.pose)
    msg.pose.covariance = DRIVE_COVARIANCE
    msg.twist.twist.linear.x = reading.forward
    msg.twist.twist.linear.y = reading.leftward
    msg.twist.twist.angular.z = reading.yaw_rate
    return msg


def planar_covariance(x: float, y: float, yaw: float) -> list[float]:
    """6x6, row by row, from x, y (m^2) and yaw (rad^2); z, roll and pitch are unknown."""
    return diagonal((x, y, *(UNKNOWN_VARIANCE,) * 3, yaw))


DRIVE_COVARIANCE = planar_covariance(1e-5, 1e-5, 1e-3)


def joints_to_msg(reading: JointReading, velocities: bool = True) -> JointState:
    """sensor_msgs/JointState; efforts stay empty."""
    msg = stamped(JointState(name=list(reading.names), position=list(reading.positions)),
                  reading.time)
    if velocities:
        msg.velocity = list(reading.velocities)
    return msg


def laser_to_msg(reading: LaserReading) -> LaserScan:
    """sensor_msgs/LaserScan without header; the last beam of a row points to angle_max.

    Rows follow each other.
    """
    gaps = max(1, len(reading.ranges) // reading.rows - 1)
    return LaserScan(angle_min=reading.angle_min, angle_max=reading.angle_max,
                     angle_increment=(reading.angle_max - reading.angle_min) / gaps,
                     range_min=reading.range_min, range_max=reading.range_max,
                     ranges=reading.ranges.tolist(), intensities=reading.intensities.tolist())


def imu_to_msg(orientation: Sequence[float], angular_velocity: Sequence[float],
               linear_acceleration: Sequence[float], variance: float = 0.0) -> Imu:
    """sensor_msgs/Imu without header: quaternion, rad/s, m/s^2, and one variance for all."""
    covariance = diagonal([variance] * 3)
    return Imu(orientation=QuaternionMsg(*orientation),
               angular_velocity=Vector3(*angular_velocity),
               linear_acceleration=Vector3(*linear_acceleration),
               orientation_covariance=covariance, angular_velocity_covariance=covariance,
               linear_acceleration_covariance=covariance)


def image_to_msg(rgb: np.ndarray, time: float, frame: str, encoding: str = "rgb8") -> ArrayImage:
    """sensor_msgs/Image of an (h, w, 3) uint8 RGB image, in one of cameras.encodings."""
    return _image(encode(rgb, encoding), time, frame, encoding)


def remove_outside(depth: np.ndarray, near: float, far: float) -> None:
    """Set values of an (h, w) float32 depth in m that are not in `near` to `far` to NaN."""
    nothing = np.full_like(depth[:STRIP], math.nan)
    for rows in strips(len(depth)):
        part = depth[rows]
        outside = (part < near) | (part > far)
        # OpenCV's masked copy is three times as fast as NumPy's.
        cv2.copyTo(nothing[:len(part)], outside.view(np.uint8), part)


def depth_to_msg(depth: np.ndarray, time: float, frame: str, millimetres: bool) -> ArrayImage:
    """A depth image: 32FC1 in m with NaN for no value, or 16UC1 in mm with 0 for no value."""
    if not millimetres:
        return _image(depth.astype(np.float32, copy=False), time, frame, "32FC1")
    scaled = np.nan_to_num(depth * 1000.0, nan=0.0, posinf=0.0)
    return _image(np.clip(np.rint(scaled), 0, 65535).astype(np.uint16), time, frame, "16UC1")


def _image(array: np.ndarray, time: float, frame: str, encoding: str) -> ArrayImage:
    return stamped(ArrayImage(np.ascontiguousarray(array), encoding=encoding), time, frame)


def points_to_msg(depth: np.ndarray, rgb: np.ndarray, focal_px: float, time: float,
                  frame: str) -> ArrayPointCloud2:
    """Organised cloud in optical axes (x right, y down, z forward); NaN where depth is NaN."""
    height, width = depth.shape
    columns = (np.arange(width, dtype=np.float32) - (width - 1) / 2) / np.float32(focal_px)
    rows = (np.arange(height, dtype=np.float32)[:, None] - (height - 1) / 2) / np.float32(focal_px)
    points = np.empty((height, width, 4), np.float32)
    is_dense = True
    for strip in strips(height):
        colours = cv2.cvtColor(rgb[strip], cv2.COLOR_RGB2BGRA).view("<u4")[..., 0]
        colours &= 0xFFFFFF
        z = depth[strip]
        cv2.merge([z * columns, z * rows[strip], z, colours.view(np.float32)], points[strip])
        is_dense = is_dense and not np.isnan(z).any()
    return stamped(ArrayPointCloud2(points, ("x", "y", "z", "rgb"), is_dense=is_dense), time,
                   frame)


def camera_info_to_msg(camera: CameraDescription, time: float, frame: str, *, centre_x: float = 0,
                       centre_y: float = 0, focal_length: float = 0, baseline: float = 0,
                       distortion: tuple[float, ...] = (0.0,) * 5) -> CameraInfo:
    """sensor_msgs/CameraInfo; zeros stand for the values of gazebo_ros_camera_utils.cpp, Init."""
    focal = focal_length or camera.width / (2 * math.tan(camera.horizontal_fov / 2))
    cx, cy = centre_x or (camera.width + 1) / 2, centre_y or (camera.height + 1) / 2
    msg = stamped(CameraInfo(height=camera.height, width=camera.width,
                             distortion_model="plumb_bob"), time, frame)
    msg.D = list(distortion)
    msg.K = [focal, 0, cx, 0, focal, cy, 0, 0, 1]
    msg.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    msg.P = [focal, 0, cx, -focal * baseline, 0, focal, cy, 0, 0, 0, 1, 0]
    return msg

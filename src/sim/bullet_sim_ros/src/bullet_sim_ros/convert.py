"""From the core's readings to ROS messages and back: pure functions, nothing is published here."""

from __future__ import annotations

import math

import numpy as np
import rospy
from geometry_msgs.msg import Point, TransformStamped, Vector3
from geometry_msgs.msg import Pose as PoseMsg
from geometry_msgs.msg import Quaternion as QuaternionMsg
from geometry_msgs.msg import Twist as TwistMsg
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Imu, JointState, LaserScan, PointCloud2, PointField

from bullet_sim.description import CameraDescription
from bullet_sim.pose import Pose, normalised
from bullet_sim.profiler import Profiler
from bullet_sim.sensors.imu import ImuReading
from bullet_sim.sensors.joint_states import JointReading
from bullet_sim.sensors.laser import LaserReading
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.twist import Twist
from bullet_sim_ros.array_image import ArrayImage
from bullet_sim_ros.cameras.encodings import encode

UNKNOWN_VARIANCE = 1e12
DRIVE_VARIANCES = (1e-5, 1e-5, 1e-3)  # of x, y, yaw: what gazebo_ros_diff_drive says of itself
# m, m/s or rad/s; the engine makes NaN of much larger numbers, and a body never recovers from it.
LARGEST = 1e6


def stamp(seconds: float) -> rospy.Time:
    """Simulated seconds to the nearest nanosecond (rospy.Time.from_sec truncates)."""
    return rospy.Time(0, round(seconds * 1e9))


def pose_to_msg(pose: Pose) -> PoseMsg:
    """geometry_msgs/Pose."""
    return PoseMsg(Point(*pose.position), QuaternionMsg(*pose.orientation))


def pose_from_msg(msg: PoseMsg) -> Pose:
    """A pose with a unit quaternion; (0, 0, 0, 0) becomes no rotation."""
    p, q = msg.position, msg.orientation
    return Pose((p.x, p.y, p.z), normalised((q.x, q.y, q.z, q.w)))


def twist_to_msg(twist: Twist) -> TwistMsg:
    """geometry_msgs/Twist."""
    return TwistMsg(Vector3(*twist.linear), Vector3(*twist.angular))


def twist_from_msg(msg: TwistMsg) -> Twist:
    """The core's twist."""
    return Twist((msg.linear.x, msg.linear.y, msg.linear.z),
                 (msg.angular.x, msg.angular.y, msg.angular.z))


def is_sane(*messages: PoseMsg | TwistMsg | Vector3) -> bool:
    """Whether every number of some Pose, Twist or Vector3 messages is finite, up to LARGEST."""
    return all(abs(value) <= LARGEST for message in messages for value in _numbers(message))


def _numbers(message) -> list[float]:
    values = [getattr(message, slot) for slot in message.__slots__]
    return [n for v in values for n in (_numbers(v) if hasattr(v, "__slots__") else [v])]


def transform_to_msg(pose: Pose, time: float, parent: str, child: str) -> TransformStamped:
    """`child` seen from `parent`."""
    msg = TransformStamped()
    msg.header.stamp, msg.header.frame_id, msg.child_frame_id = stamp(time), parent, child
    msg.transform.translation = Vector3(*pose.position)
    msg.transform.rotation = QuaternionMsg(*pose.orientation)
    return msg


def odometry_to_msg(reading: OdometryReading, frame: str, child: str,
                    variances: tuple[float, float, float] = DRIVE_VARIANCES) -> Odometry:
    """nav_msgs/Odometry; the variances are those of x, y (m^2) and yaw (rad^2)."""
    msg = Odometry()
    msg.header.stamp, msg.header.frame_id = stamp(reading.time), frame
    msg.child_frame_id = child
    msg.pose.pose = pose_to_msg(reading.pose)
    msg.pose.covariance = planar_covariance(*variances)
    msg.twist.twist.linear.x = reading.forward
    msg.twist.twist.linear.y = reading.leftward
    msg.twist.twist.angular.z = reading.yaw_rate
    return msg


def planar_covariance(x: float, y: float, yaw: float) -> list[float]:
    """36 numbers, row by row, of something that knows nothing of height, roll and pitch."""
    unknown = (UNKNOWN_VARIANCE,) * 3
    return np.diag((x, y, *unknown, yaw)).ravel().tolist()


def joints_to_msg(reading: JointReading, velocities: bool = True) -> JointState:
    """sensor_msgs/JointState; efforts stay empty."""
    msg = JointState(name=list(reading.names), position=list(reading.positions))
    msg.header.stamp = stamp(reading.time)
    if velocities:
        msg.velocity = list(reading.velocities)
    return msg


def laser_to_msg(reading: LaserReading, frame: str) -> LaserScan:
    """sensor_msgs/LaserScan; the last beam of a row points to angle_max. Rows follow each other."""
    msg = LaserScan()
    msg.header.stamp, msg.header.frame_id = stamp(reading.time), frame
    msg.angle_min, msg.angle_max = reading.angle_min, reading.angle_max
    gaps = max(1, len(reading.ranges) // reading.rows - 1)
    msg.angle_increment = (reading.angle_max - reading.angle_min) / gaps
    msg.range_min, msg.range_max = reading.range_min, reading.range_max
    msg.ranges, msg.intensities = reading.ranges.tolist(), reading.intensities.tolist()
    return msg


def imu_to_msg(reading: ImuReading, frame: str, variance: float) -> Imu:
    """sensor_msgs/Imu of a reading already in the axes that it is to be published in."""
    msg = Imu()
    msg.header.stamp, msg.header.frame_id = stamp(reading.time), frame
    msg.orientation = QuaternionMsg(*reading.orientation)
    msg.angular_velocity = Vector3(*reading.angular_velocity)
    msg.linear_acceleration = Vector3(*reading.linear_acceleration)
    diagonal = np.diag([variance] * 3).ravel().tolist()
    msg.orientation_covariance = diagonal
    msg.angular_velocity_covariance = diagonal
    msg.linear_acceleration_covariance = diagonal
    return msg


def image_to_msg(rgb: np.ndarray, time: float, frame: str, encoding: str = "rgb8",
                 profiler: Profiler | None = None) -> ArrayImage:
    """sensor_msgs/Image of an (h, w, 3) uint8 RGB picture in any encoding of cameras."""
    return _image(encode(rgb, encoding), time, frame, encoding, profiler)


def depth_to_msg(depth: np.ndarray, time: float, frame: str, millimetres: bool) -> ArrayImage:
    """32FC1 in m with NaN for no value, or 16UC1 in mm with 0."""
    if not millimetres:
        return _image(depth.astype(np.float32, copy=False), time, frame, "32FC1")
    scaled = np.nan_to_num(depth * 1000.0, nan=0.0, posinf=0.0)
    return _image(np.clip(np.rint(scaled), 0, 65535).astype(np.uint16), time, frame, "16UC1")


def _image(array: np.ndarray, time: float, frame: str, encoding: str,
           profiler: Profiler | None = None) -> ArrayImage:
    msg = ArrayImage(np.ascontiguousarray(array), profiler, encoding=encoding)
    msg.header.stamp, msg.header.frame_id = stamp(time), frame
    return msg


def points_to_msg(depth: np.ndarray, rgb: np.ndarray, focal_px: float, time: float,
                  frame: str) -> PointCloud2:
    """Organised cloud in optical axes (x right, y down, z forward); NaN where depth is NaN."""
    height, width = depth.shape
    cloud = np.zeros((height, width), dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"),
                                             ("rgb", "<u4")])
    columns = (np.arange(width, dtype=np.float32) - (width - 1) / 2) / focal_px
    rows = (np.arange(height, dtype=np.float32) - (height - 1) / 2) / focal_px
    cloud["x"], cloud["y"], cloud["z"] = depth * columns, depth * rows[:, None], depth
    channels = rgb.astype(np.uint32)
    cloud["rgb"] = channels[..., 0] << 16 | channels[..., 1] << 8 | channels[..., 2]
    msg = PointCloud2(height=height, width=width, point_step=16, row_step=16 * width)
    msg.header.stamp, msg.header.frame_id = stamp(time), frame
    msg.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1)
                  for i, name in enumerate(("x", "y", "z", "rgb"))]
    msg.is_dense = not np.isnan(depth).any()
    msg.data = cloud.tobytes()
    return msg


def camera_info_to_msg(camera: CameraDescription, time: float, frame: str, *, centre_x: float = 0,
                       centre_y: float = 0, focal_length: float = 0, baseline: float = 0,
                       distortion: tuple[float, ...] = (0.0,) * 5) -> CameraInfo:
    """sensor_msgs/CameraInfo; zeros stand for Gazebo's defaults, (width + 1) / 2 among them."""
    focal = focal_length or camera.width / (2 * math.tan(camera.horizontal_fov / 2))
    cx, cy = centre_x or (camera.width + 1) / 2, centre_y or (camera.height + 1) / 2
    msg = CameraInfo(height=camera.height, width=camera.width, distortion_model="plumb_bob")
    msg.header.stamp, msg.header.frame_id = stamp(time), frame
    msg.D = list(distortion)
    msg.K = [focal, 0, cx, 0, focal, cy, 0, 0, 1]
    msg.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    msg.P = [focal, 0, cx, -focal * baseline, 0, focal, cy, 0, 0, 0, 1, 0]
    return msg

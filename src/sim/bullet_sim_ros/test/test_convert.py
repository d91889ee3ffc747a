"""Conversions between readings and messages, without a master."""

import io
import math

import numpy as np
import pytest
from geometry_msgs.msg import Pose as PoseMsg
from geometry_msgs.msg import Twist as TwistMsg
from sensor_msgs.msg import PointCloud2

from bullet_sim.description import CameraDescription
from bullet_sim.pose import Pose
from bullet_sim.sensors.joint_states import JointReading
from bullet_sim.sensors.laser import LaserReading
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.twist import Twist
from bullet_sim_ros import convert
from bullet_sim_ros.array_messages import ArrayImage, ArrayPointCloud2


@pytest.mark.parametrize("seconds, secs, nsecs", [
    (0.0, 0, 0), (0.29, 0, 290_000_000), (1.1, 1, 100_000_000), (123.001, 123, 1_000_000)])
def test_stamps_are_rounded_not_truncated(seconds, secs, nsecs):
    made = convert.stamp(seconds)
    assert (made.secs, made.nsecs) == (secs, nsecs)


def test_poses_and_twists_go_there_and_back():
    pose = Pose.from_xyz_rpy((1.0, -2.0, 3.0), (0.1, 0.2, 0.3))
    back = convert.pose_from_msg(convert.pose_to_msg(pose))
    assert back.position == pose.position
    assert back.orientation == pytest.approx(pose.orientation)
    twist = Twist((1.0, 2.0, 3.0), (-1.0, -2.0, -3.0))
    assert convert.twist_from_msg(convert.twist_to_msg(twist)) == twist


def test_a_default_pose_message_is_no_rotation():
    assert convert.pose_from_msg(PoseMsg()).orientation == (0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("value, sane", [
    (1.0, True), (-1e5, True), (math.nan, False), (-math.inf, False), (1e200, False)])
def test_numbers_that_no_engine_can_take_are_found_at_any_depth(value, sane):
    twist = TwistMsg()
    twist.angular.z = value
    assert convert.is_sane(PoseMsg(), twist) is sane


def test_laser_keeps_infinities_and_spreads_the_angles():
    ranges = np.array([math.inf, 1.5, -math.inf], np.float32)
    msg = convert.laser_to_msg(
        LaserReading(2.0, ranges, np.zeros(3, np.float32), 0.0, 6.28319, 0.12, 3.5, 1))
    assert msg.ranges == [math.inf, 1.5, -math.inf]
    assert msg.angle_increment == pytest.approx(6.28319 / 2)
    assert (msg.time_increment, msg.intensities) == (0, [0, 0, 0])
    header = convert.stamped(msg, 2.5, "base_scan").header
    assert (header.frame_id, header.stamp.to_nsec()) == ("base_scan", 2_500_000_000)


def test_odometry_has_the_covariances_of_upstream():
    reading = OdometryReading(1.0, Pose((1, 2, 0)), 0.15, 0.0, 0.5)
    msg = convert.odometry_to_msg(reading, "odom", "base_footprint")
    assert [msg.pose.covariance[7 * i] for i in range(6)] == [1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3]
    assert (msg.twist.twist.linear.x, msg.twist.twist.angular.z) == (0.15, 0.5)
    assert (msg.header.frame_id, msg.child_frame_id) == ("odom", "base_footprint")


def test_joint_states_leave_efforts_empty():
    msg = convert.joints_to_msg(JointReading(0.0, ("a", "b"), (1.0, 2.0), (3.0, 4.0)))
    assert (msg.name, msg.position, msg.velocity, msg.effort) == (
        ["a", "b"], [1.0, 2.0], [3.0, 4.0], [])


def test_imu_variance_is_on_the_diagonals():
    msg = convert.imu_to_msg((0, 0, 0, 1), (0, 0, 1), (0, 0, 0), 0.04)
    assert msg.angular_velocity_covariance == [0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.04]


RED = np.full((2, 3, 3), (255, 0, 10), np.uint8)


@pytest.mark.parametrize("encoding, first", [
    ("rgb8", b"\xff\x00\x0a"), ("bgr8", b"\x0a\x00\xff"), ("mono8", bytes([77]))])
def test_images_in_each_encoding(encoding, first):
    msg = convert.image_to_msg(RED, 1.5, "camera", encoding)
    assert (msg.height, msg.width, msg.encoding, msg.step) == (2, 3, encoding, 3 * len(first))
    assert msg.data == first * 6


def test_depth_in_metres_and_millimetres():
    depth = np.array([[1.0, math.nan], [0.5, 2.0]], np.float32)
    metres = convert.depth_to_msg(depth, 0.0, "f", millimetres=False)
    assert (metres.encoding, metres.step) == ("32FC1", 8)
    assert np.array_equal(np.frombuffer(metres.data, np.float32).reshape(2, 2), depth,
                          equal_nan=True)
    millimetres = convert.depth_to_msg(depth, 0.0, "f", millimetres=True)
    assert np.frombuffer(millimetres.data, np.uint16).tolist() == [1000, 0, 500, 2000]


def test_points_are_in_optical_axes_with_colour():
    depth = np.full((3, 5), 2.0, np.float32)
    depth[0, 0] = math.nan
    rgb = np.zeros((3, 5, 3), np.uint8)
    rgb[2, 4] = (255, 128, 1)
    msg = convert.points_to_msg(depth, rgb, 4.0, 0.0, "optical")
    cloud = np.frombuffer(msg.data, np.dtype("<f4,<f4,<f4,<u4")).reshape(3, 5)
    assert cloud[1, 2].item()[:3] == (0.0, 0.0, 2.0)
    assert cloud[2, 4].item()[:3] == (1.0, 0.5, 2.0)  # right and down are positive
    assert cloud[2, 4][3] == 0xFF8001
    assert math.isnan(cloud[0, 0][0])
    assert not msg.is_dense
    assert [field.name for field in msg.fields] == ["x", "y", "z", "rgb"]


@pytest.mark.parametrize("hole", [False, True])
def test_points_go_out_as_the_generated_class_packs_them(hole):
    depth = np.linspace(1.0, 3.0, 15, dtype=np.float32).reshape(3, 5)
    depth[1, 1] = math.nan if hole else 2.0
    msg = convert.points_to_msg(depth, np.full((3, 5, 3), 200, np.uint8), 4.0, 1.5, "optical")
    sent, packed = io.BytesIO(), io.BytesIO()
    msg.serialize(sent)
    PointCloud2(**{name: getattr(msg, name) for name in msg.__slots__}).serialize(packed)
    assert sent.getvalue() == packed.getvalue()
    back = PointCloud2().deserialize(sent.getvalue())
    assert (back.width, back.height, back.point_step, back.row_step) == (5, 3, 16, 80)
    assert back.is_dense is not hole and back.header.stamp.to_sec() == 1.5


class Uncopied(np.ndarray):
    """An array that may be written to the wire, and not be made bytes before."""

    def tobytes(self, *_):
        raise AssertionError("copied")


@pytest.mark.parametrize("made", [
    lambda: ArrayImage(np.zeros((3, 5, 3), np.uint8).view(Uncopied), encoding="rgb8"),
    lambda: ArrayPointCloud2(np.zeros((3, 5, 4), np.float32).view(Uncopied), "xyz_")])
def test_what_an_array_holds_is_not_copied_before_it_is_sent(made):
    made().serialize(io.BytesIO())


def test_depth_that_is_too_near_or_too_far_is_none():
    depth = np.array([[0.3, 0.4], [3.0, np.inf]] * 20, np.float32)  # more rows than go at once
    convert.remove_outside(depth, 0.4, 3.0)
    assert np.array_equal(depth, np.array([[np.nan, 0.4], [3.0, np.nan]] * 20, np.float32),
                          equal_nan=True)


def test_camera_info_has_gazebos_principal_point():
    camera = CameraDescription(horizontal_fov=1.3439, width=1920, height=1080)
    msg = convert.camera_info_to_msg(camera, 0.0, "f", baseline=0.07)
    focal = 1920 / (2 * math.tan(1.3439 / 2))
    assert list(msg.K) == pytest.approx([focal, 0, 960.5, 0, focal, 540.5, 0, 0, 1])
    assert msg.P[3] == pytest.approx(-focal * 0.07)
    assert (msg.distortion_model, len(msg.D)) == ("plumb_bob", 5)

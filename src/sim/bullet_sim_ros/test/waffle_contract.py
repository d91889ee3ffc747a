"""The waffle over ROS: topics, rates, frames, units and motion."""

import math
import unittest

import numpy as np
import rospy
import tf2_ros
from contracts import LIMIT, wait_until
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image, Imu, JointState, LaserScan, PointCloud2
from std_srvs.srv import Empty

FOCAL_PX = 1920 / (2 * math.tan(1.3439 / 2))


def one(topic, kind):
    return rospy.wait_for_message(topic, kind, LIMIT)


def collect(topic, kind, count):
    """So many messages in a row."""
    found = []
    subscriber = rospy.Subscriber(topic, kind, found.append, queue_size=100, buff_size=2 ** 24)
    wait_until(lambda: len(found) >= count, f"{count} messages on {topic}")
    subscriber.unregister()
    return found[:count]


def rate_hz(stamps):
    """Usual rate in simulated time; the first may be a latched old one, and one may be lost."""
    return 1 / float(np.median(np.diff(stamps)))


class Waffle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.command = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        cls.transforms = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.transforms)
        one("/odom", Odometry)

    def setUp(self):
        self.command.publish(Twist())
        rospy.ServiceProxy("/gazebo/reset_world", Empty)()

    def truth(self):
        return rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)("turtlebot3_waffle", "")

    def drive(self, forward, yaw_rate, seconds):
        """Command, wait until the wheels have sped up, then measure over simulated seconds."""
        command = Twist()
        command.linear.x, command.angular.z = forward, yaw_rate
        wait_until(self.command.get_num_connections, "a subscriber of cmd_vel")
        self.command.publish(command)
        begin = rospy.get_time()
        wait_until(lambda: rospy.get_time() > begin + 1.0, "the ramp")
        first = self.truth()
        start = first.header.stamp.to_sec()
        wait_until(lambda: rospy.get_time() > start + seconds, "the drive")
        last = self.truth()
        return first, last, last.header.stamp.to_sec() - start

    # --- topics

    def test_the_camera_gives_1080p_near_30_hz(self):
        images = collect("/camera/rgb/image_raw", Image, 31)
        first = images[0]
        self.assertEqual((first.width, first.height, first.encoding, first.step),
                         (1920, 1080, "rgb8", 5760))
        self.assertEqual(first.header.frame_id, "camera_rgb_optical_frame")
        rate = rate_hz([image.header.stamp.to_sec() for image in images])
        self.assertAlmostEqual(rate, 30.0, delta=1.0)

    def test_the_start_shows_the_yellow_line_ahead_and_white_to_the_right(self):
        image = collect("/camera/rgb/image_raw", Image, 3)[-1]  # the first is a latched old one
        rgb = np.frombuffer(image.data, np.uint8).reshape(1080, 1920, 3)[900:920].astype(int)
        red, green, blue = rgb[..., 0], rgb[..., 1], rgb[..., 2]
        yellow = np.nonzero((red > 150) & (green > 150) & (blue < 80))[1]
        white = np.nonzero((red > 150) & (green > 150) & (blue > 150))[1]
        self.assertGreater(len(yellow), 500)
        self.assertLess(yellow.mean(), 960)
        if len(white):
            self.assertGreater(white.mean(), yellow.mean())

    def test_camera_info_fits_the_picture(self):
        info = one("/camera/rgb/camera_info", CameraInfo)
        self.assertEqual((info.width, info.height), (1920, 1080))
        self.assertAlmostEqual(info.K[0], FOCAL_PX, places=3)
        self.assertEqual(info.header.frame_id, "camera_rgb_optical_frame")

    def test_depth_of_the_floor_is_the_closed_form(self):
        image = one("/camera/depth/image_raw", Image)
        self.assertEqual((image.encoding, image.step), ("32FC1", 1920 * 4))
        depth = np.frombuffer(image.data, np.float32).reshape(1080, 1920)
        height = 0.010 + 0.094 + 0.013
        for row in (740, 800, 850):
            self.assertAlmostEqual(depth[row, 960], height * FOCAL_PX / (row - 539.5), delta=0.02)
        self.assertTrue(math.isnan(depth[100, 960]))

    def test_points_lie_on_the_floor(self):
        cloud = one("/camera/depth/points", PointCloud2)
        self.assertEqual((cloud.width, cloud.height), (1920, 1080))
        y = np.frombuffer(cloud.data, np.dtype("<f4,<f4,<f4,<u4")).reshape(1080, 1920)[800]["f1"]
        self.assertAlmostEqual(float(np.nanmedian(y)), 0.117, delta=0.002)

    def test_the_laser(self):
        scans = collect("/scan", LaserScan, 6)
        scan = scans[0]
        self.assertEqual((len(scan.ranges), scan.header.frame_id), (360, "base_scan"))
        self.assertAlmostEqual(scan.angle_max, 6.28319, places=5)
        self.assertAlmostEqual(rate_hz([s.header.stamp.to_sec() for s in scans]), 5.0, delta=0.1)
        self.assertTrue(all(math.isinf(r) and r > 0 for r in scan.ranges))  # nothing stands there

    def test_imu_odometry_and_joint_states(self):
        imu = one("/imu", Imu)
        self.assertEqual(imu.header.frame_id, "base_footprint")  # as lumping renames it upstream
        self.assertAlmostEqual(imu.linear_acceleration.z, 0.0, delta=0.5)
        odometry = one("/odom", Odometry)
        self.assertEqual((odometry.header.frame_id, odometry.child_frame_id),
                         ("odom", "base_footprint"))
        joints = one("/joint_states", JointState)
        self.assertEqual(joints.name, ["wheel_left_joint", "wheel_right_joint"])

    def test_the_frames_hang_together(self):
        wait_until(lambda: self.transforms.can_transform(
            "odom", "camera_rgb_optical_frame", rospy.Time()), "odom to the camera")
        camera = self.transforms.lookup_transform(
            "base_footprint", "camera_rgb_optical_frame", rospy.Time()).transform.translation
        self.assertAlmostEqual(camera.x, 0.069, places=3)
        self.assertAlmostEqual(camera.y, -0.047, places=3)
        self.assertAlmostEqual(camera.z, 0.117, places=3)

    # --- motion

    def test_commanded_speed_and_odometry_within_one_percent(self):
        first, last, seconds = self.drive(0.15, 0.0, 6.0)
        a, b = first.pose.position, last.pose.position
        self.assertAlmostEqual(math.hypot(b.x - a.x, b.y - a.y) / seconds, 0.15, delta=0.0015)
        odometry = one("/odom", Odometry)
        self.assertAlmostEqual(odometry.twist.twist.linear.x, 0.15, delta=0.0015)
        truth = self.truth()
        self.assertAlmostEqual(odometry.pose.pose.position.x, truth.pose.position.x, delta=0.02)

    def test_commanded_turn_within_one_percent(self):
        first, last, seconds = self.drive(0.0, 0.5, 6.0)
        turned = (yaw(last) - yaw(first)) % (2 * math.pi)
        self.assertAlmostEqual(turned / seconds, 0.5, delta=0.005)


def yaw(state):
    q = state.pose.orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))

"""The racecar as bringup starts it: what its sensors publish, and where it stands."""

import math
import unittest

import numpy as np
import rospy
import tf2_ros
from acceptance_car import LIMIT, wait_until
from gazebo_msgs.srv import GetModelState
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan

START = (0.0, 0.0)  # m
FOCAL_PX = 1280 / (2 * math.tan(1.3963 / 2))


def one(topic, kind):
    return rospy.wait_for_message(topic, kind, LIMIT)


def collect(topic, kind, count):
    """So many messages in a row."""
    found = []
    subscriber = rospy.Subscriber(topic, kind, found.append, queue_size=100, buff_size=2 ** 24)
    wait_until(lambda: len(found) >= count, f"{count} messages on {topic}")
    subscriber.unregister()
    return found[:count]


def rate_hz(messages):
    """Usual rate in simulated time; the first message may be a latched old one."""
    return 1 / float(np.median(np.diff([each.header.stamp.to_sec() for each in messages])))


class Racecar(unittest.TestCase):
    def test_it_stands_at_the_start_line(self):
        truth = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)
        truth.wait_for_service(LIMIT)
        wait_until(lambda: truth("racecar", "").success, "the car")
        begin = rospy.get_time()
        wait_until(lambda: rospy.get_time() > begin + 1.0, "a second of simulated time")
        state = truth("racecar", "")
        where = state.pose.position
        np.testing.assert_allclose((where.x, where.y, where.z), (*START, 0.0), atol=2e-3)
        self.assertLess(2 * math.asin(abs(state.pose.orientation.z)), 2e-3)  # eastwards
        self.assertLess(abs(state.twist.linear.x), 1e-3)

    def test_the_camera_gives_720p_at_30_hz(self):
        images = collect("/camera/image_raw", Image, 31)
        last = images[-1]
        self.assertEqual((last.width, last.height, last.encoding), (1280, 720, "rgb8"))
        self.assertEqual(last.header.frame_id, "camera_optical_link")
        self.assertAlmostEqual(rate_hz(images), 30.0, delta=1.0)

    def test_the_camera_sees_the_line_ahead_and_the_horizon(self):
        image = collect("/camera/image_raw", Image, 3)[-1]
        rgb = np.frombuffer(image.data, np.uint8).reshape(720, 1280, 3).astype(int)
        red, green, blue = rgb[..., 0], rgb[..., 1], rgb[..., 2]
        yellow = (red > 150) & (green > 130) & (blue < 90)
        for row in (350, 500, 700):
            self.assertAlmostEqual(np.flatnonzero(yellow[row]).mean(), 639.5, delta=5)
        self.assertGreater(blue[:100].min(), 150)  # sky
        self.assertFalse((red[300:] - green[300:] > 60).any())  # nothing of the car itself

    def test_camera_info_fits_the_picture(self):
        info = one("/camera/camera_info", CameraInfo)
        self.assertEqual((info.width, info.height), (1280, 720))
        self.assertAlmostEqual(info.K[0], FOCAL_PX, places=2)
        self.assertEqual(info.header.frame_id, "camera_optical_link")

    def test_the_laser_measures_the_walls(self):
        scans = collect("/scan", LaserScan, 5)
        last = scans[-1]
        self.assertEqual((len(last.ranges), last.header.frame_id), (541, "laser_link"))
        self.assertAlmostEqual(last.angle_min, -0.75 * math.pi, places=4)
        self.assertAlmostEqual(rate_hz(scans), 20.0, delta=0.5)
        ahead, right = np.median(last.ranges[266:275]), np.median(last.ranges[88:93])
        self.assertAlmostEqual(ahead, 7.0 - (START[0] + 0.355), delta=0.03)
        self.assertAlmostEqual(right, START[1] + 0.8, delta=0.03)

    def test_the_imu(self):
        readings = collect("/imu", Imu, 20)
        self.assertEqual(readings[-1].header.frame_id, "base_link")
        self.assertAlmostEqual(rate_hz(readings), 100.0, delta=1.0)

    def test_ground_truth(self):
        odometry = collect("/ground_truth", Odometry, 10)
        last = odometry[-1]
        self.assertEqual((last.header.frame_id, last.child_frame_id), ("world", "base_link"))
        self.assertAlmostEqual(rate_hz(odometry), 50.0, delta=0.5)
        where = last.pose.pose.position
        np.testing.assert_allclose((where.x, where.y), START, atol=2e-3)

    def test_fixed_frames(self):
        transforms = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(transforms)
        for frame, place in (("camera_optical_link", (0.385, 0.0, 0.20)),
                             ("laser_link", (0.355, 0.0, 0.125))):
            found = transforms.lookup_transform("base_link", frame, rospy.Time(0),
                                                rospy.Duration(LIMIT)).transform.translation
            np.testing.assert_allclose((found.x, found.y, found.z), place, atol=1e-6)
        listener.unregister()

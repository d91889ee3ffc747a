#!/usr/bin/env python3
"""The car among the obstacles: what each sensor sees, and that it drives as it is told."""

import math
import sys
import threading
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, LaserScan, PointCloud2

LIMIT = 60.0  # s of wall time, for whatever is waited for
LASER_TO_WALL = 2.0  # m, all round from the middle of the room


def yaw(orientation):
    return 2 * math.atan2(orientation.z, orientation.w)


class Car(unittest.TestCase):
    def test_1_laser(self):
        scan = rospy.wait_for_message("/scan", LaserScan, LIMIT)
        self.assertEqual((scan.header.frame_id, len(scan.ranges)), ("laser", 360))
        behind = scan.ranges[0]  # its first beam looks back
        right = scan.ranges[90]
        self.assertAlmostEqual(behind, LASER_TO_WALL, delta=0.06)
        self.assertAlmostEqual(right, LASER_TO_WALL, delta=0.06)
        # The red cylinder, 1.34 m away and 0.15 m thick.
        towards = scan.ranges[180 + round(math.degrees(math.atan2(0.6, 1.2)))]
        self.assertAlmostEqual(towards, math.hypot(1.2, 0.6) - 0.15, delta=0.06)

    def test_2_camera(self):
        image = rospy.wait_for_message("/camera/image_raw", Image, LIMIT)
        self.assertEqual((image.width, image.height, image.encoding), (640, 480, "rgb8"))
        self.assertEqual(image.header.frame_id, "camera_optical")
        rgb = np.frombuffer(image.data, np.uint8).reshape(480, 640, 3).astype(int)
        yellow = (rgb[..., 0] > 100) & (rgb[..., 1] > 100) & (rgb[..., 2] < 80)
        red = (rgb[..., 0] > 80) & (rgb[..., 1] < 50) & (rgb[..., 2] < 50)
        green = (rgb[..., 1] > 60) & (rgb[..., 0] < 50) & (rgb[..., 2] < 50)
        for colour in (yellow, red, green):
            self.assertGreater(np.count_nonzero(colour), 500)
        self.assertAlmostEqual(np.nonzero(yellow)[1].mean(), 320, delta=10)  # straight ahead
        self.assertLess(np.nonzero(red)[1].mean(), 320)  # on the left
        self.assertGreater(np.nonzero(green)[1].mean(), 320)

    def test_3_depth_camera(self):
        depth = rospy.wait_for_message("/kinect/depth/image_raw", Image, LIMIT)
        self.assertEqual((depth.encoding, depth.header.frame_id), ("32FC1", "kinect_optical"))
        metres = np.frombuffer(depth.data, np.float32).reshape(depth.height, depth.width)
        # It looks over the yellow box, at the wall; its lens is 0.01 m before the middle.
        self.assertAlmostEqual(metres[240, 320], LASER_TO_WALL - 0.01, delta=0.05)
        points = rospy.wait_for_message("/kinect/depth/points", PointCloud2, LIMIT)
        self.assertEqual((points.width, points.height), (640, 480))

    def test_4_drives_and_turns_as_told(self):
        came, last = threading.Condition(), {}

        def keep(name, message):
            with came:
                last[name] = message
                came.notify_all()

        def wait_for(condition, what):
            with came:
                self.assertTrue(came.wait_for(condition, LIMIT), f"{what}: {last.get('odom')}")

        rospy.Subscriber("/odom", Odometry, lambda message: keep("odom", message))
        rospy.Subscriber("/gazebo/model_states", ModelStates,
                         lambda message: keep("truth", message))
        publisher = rospy.Publisher("/cmd_vel", Twist, queue_size=1, latch=True)
        wait_for(lambda: len(last) == 2, "odometry and the true pose")
        command = Twist()
        command.linear.x = -0.2
        publisher.publish(command)
        wait_for(lambda: last["odom"].pose.pose.position.x < -0.3, "driving back")
        command.linear.x, command.angular.z = 0.0, 0.5
        publisher.publish(command)
        wait_for(lambda: yaw(last["odom"].pose.pose.orientation) > 1.0, "a turn to the left")
        publisher.publish(Twist())
        wait_for(lambda: abs(last["odom"].twist.twist.angular.z) < 1e-3, "standing")
        odom, truth = last["odom"].pose.pose, last["truth"]
        car = truth.pose[truth.name.index("mycar")]
        self.assertAlmostEqual(odom.position.x, car.position.x, delta=0.02)
        self.assertAlmostEqual(yaw(odom.orientation), yaw(car.orientation), delta=0.05)
        self.assertAlmostEqual(car.position.z, 0.0, delta=0.003)  # it neither sinks nor hops
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        for frame in ("laser", "camera_optical", "kinect_optical", "left_wheel", "front_wheel"):
            self.assertTrue(buffer.can_transform("odom", frame, rospy.Time(0),
                                                 rospy.Duration(LIMIT)), frame)
        listener.unregister()


if __name__ == "__main__":
    rospy.init_node("car_in_the_room")
    rostest.rosrun("urdf02_gazebo", "car", Car, sys.argv)

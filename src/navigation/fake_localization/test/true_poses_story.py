#!/usr/bin/env python3
"""True poses in; amcl's topics and the transform from map to odom out; initialpose moves them."""

import math
import sys
import threading
import time
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

LIMIT = 60.0  # s
TRUTH = (5.0, 2.0)     # of the base in the world, heading along x
ODOMETRY = (0.5, -0.5)  # of the base in odom
ON_MAP = (1.0, -5.0, -math.pi / 2)  # turned by -90 degrees, then 1 m back along the map's x


def yaw_of(turn):
    return 2 * math.atan2(turn.z, turn.w)


class FakeLocalization(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.odometry_comes = threading.Event()
        cls.odometry_comes.set()
        cls.truth = rospy.Publisher("base_pose_ground_truth", Odometry, queue_size=1)
        cls.wanted = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        cls.transforms = tf2_ros.TransformBroadcaster()
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        cls.over = threading.Event()
        cls.thread = threading.Thread(target=cls.robot, daemon=True)
        cls.thread.start()

    @classmethod
    def tearDownClass(cls):
        cls.over.set()
        cls.thread.join()

    @classmethod
    def robot(cls):
        while not cls.over.is_set():
            now = rospy.Time.now()
            truth = Odometry(child_frame_id="anything")
            truth.header.stamp, truth.header.frame_id = now, "world"
            truth.pose.pose.position.x, truth.pose.pose.position.y = TRUTH
            truth.pose.pose.orientation.w, truth.pose.covariance[0] = 1.0, 0.25
            cls.truth.publish(truth)
            time.sleep(0.02)  # odometry is later than the truth
            if cls.odometry_comes.is_set():
                odometry = TransformStamped(child_frame_id="base_footprint")
                odometry.header.stamp, odometry.header.frame_id = now, "odom"
                odometry.transform.translation.x, odometry.transform.translation.y = ODOMETRY
                odometry.transform.rotation.w = 1.0
                cls.transforms.sendTransform(odometry)
            time.sleep(0.03)

    def pose(self):
        return rospy.wait_for_message("amcl_pose", PoseWithCovarianceStamped, LIMIT)

    def assert_at(self, pose, x, y, yaw):
        found = (pose.position.x, pose.position.y, yaw_of(pose.orientation))
        for number, wanted in zip(found, (x, y, yaw), strict=True):
            self.assertAlmostEqual(number, wanted, places=6)

    def wait_for(self, condition, what):
        end = time.monotonic() + LIMIT
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.05)

    def test_1_pose_particle_and_transform(self):
        estimate = self.pose()
        self.assertEqual(estimate.header.frame_id, "map")
        self.assertEqual(estimate.pose.covariance[0], 0.25)
        self.assert_at(estimate.pose.pose, *ON_MAP)
        particles = rospy.wait_for_message("particlecloud", PoseArray, LIMIT)
        self.assertEqual((particles.header.frame_id, len(particles.poses)), ("map", 1))
        self.assert_at(particles.poses[0], *ON_MAP)
        found = self.buffer.lookup_transform("map", "base_footprint", rospy.Time(0),
                                             rospy.Duration(LIMIT)).transform
        self.assertAlmostEqual(found.translation.x, ON_MAP[0], places=6)
        self.assertAlmostEqual(found.translation.y, ON_MAP[1], places=6)
        self.assertAlmostEqual(yaw_of(found.rotation), ON_MAP[2], places=6)

    def test_2_transforms_are_dated_ahead(self):
        def ahead():
            """s, of the newest transform onto the map before the newest odometry."""
            return (self.buffer.get_latest_common_time("map", "odom")
                    - self.buffer.get_latest_common_time("odom", "base_footprint")).to_sec()

        self.wait_for(lambda: ahead() > 0.2, "a transform of transform_tolerance later")

    def test_3_an_initial_pose_moves_the_robot_on_the_map(self):
        self.wait_for(lambda: self.wanted.get_num_connections(), "a subscriber")
        wanted = PoseWithCovarianceStamped()
        wanted.header.frame_id = "map"
        wanted.pose.pose.position.x, wanted.pose.pose.position.y = -3.0, 4.0
        wanted.pose.pose.orientation.z = wanted.pose.pose.orientation.w = math.sqrt(0.5)
        self.wanted.publish(wanted)
        self.wait_for(lambda: abs(self.pose().pose.pose.position.x + 3.0) < 1e-6, "the move")
        self.assert_at(self.pose().pose.pose, -3.0, 4.0, math.pi / 2)

    def test_4_missing_odometry_is_named_and_then_it_goes_on(self):
        lines = []
        log = rospy.Subscriber("/rosout", Log, lambda line: lines.append(line.msg))
        self.odometry_comes.clear()
        self.wait_for(lambda: any("no new transform from odom to base_footprint for" in line
                                  for line in lines), "the line")
        log.unregister()
        before = rospy.Time.now()
        self.odometry_comes.set()
        self.wait_for(lambda: self.pose().header.stamp > before, "poses again")


if __name__ == "__main__":
    rospy.init_node("true_poses_story")
    rostest.rosrun("fake_localization", "true_poses", FakeLocalization, sys.argv)

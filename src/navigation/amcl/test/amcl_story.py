#!/usr/bin/env python3
"""A robot in a room: amcl finds it, follows what it is told, and keeps upstream's names."""

import threading
import time
import unittest

import dynamic_reconfigure.client
import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.srv import GetMap, GetMapResponse, SetMap
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty

from nav_algorithms import poses, rays
from nav_algorithms.cells import OccupancyGrid
from nav_nodes.messages import grid_message, pose_message, pose_of, transform_message

CELLS = np.zeros((80, 120), np.int8)  # 6 m x 4 m
CELLS[[0, -1]], CELLS[:, [0, -1]] = 100, 100
CELLS[60:, 70:78] = CELLS[:14, 20:40] = 100
MAP = OccupancyGrid(CELLS, 0.05, (0.0, 0.0))
ANGLES = np.arange(180) * np.radians(2.0)
LIMIT = 60.0  # s, for whatever is waited for
TRUTH = np.array([2.2, 1.7, 0.3])
ODOMETRY = np.array([5.0, -3.0, 1.0])


class AmclStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("amcl_story")
        cls.truth, cls.odometry, cls.seen = TRUTH, ODOMETRY, {}
        cls.behind = 0  # s, of its stamps
        rospy.Service("static_map", GetMap, lambda _: GetMapResponse(cls.map_message()))
        cls.scans = rospy.Publisher("scan", LaserScan, queue_size=1)
        cls.told = rospy.Publisher("initialpose", PoseWithCovarianceStamped, queue_size=1)
        for topic, kind in (("amcl_pose", PoseWithCovarianceStamped), ("particlecloud", PoseArray)):
            rospy.Subscriber(topic, kind, lambda message, name=topic: cls.seen.update(
                {name: message}))
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        threading.Thread(target=cls.be_a_robot, daemon=True).start()
        for service in ("global_localization", "request_nomotion_update", "set_map"):
            rospy.wait_for_service(service, LIMIT)

    @classmethod
    def map_message(cls):
        return grid_message(MAP, "map", rospy.Time.now())

    @classmethod
    def be_a_robot(cls):
        sender, still = tf2_ros.TransformBroadcaster(), tf2_ros.StaticTransformBroadcaster()
        still.sendTransform(transform_message(np.array([0.1, 0, 0]), "base_link", "laser",
                                              rospy.Time.now()))
        occupied = (CELLS == 100).astype(np.uint8)
        while not rospy.is_shutdown():
            now = rospy.Time.now() - rospy.Duration(cls.behind)
            sender.sendTransform(transform_message(cls.odometry, "odom", "base_link", now))
            x, y, yaw = poses.compose(cls.truth, (0.1, 0, 0))
            scan = LaserScan(angle_increment=ANGLES[1], range_min=0.1, range_max=8.0)
            scan.header.stamp, scan.header.frame_id = now, "laser"
            scan.ranges = rays.cast(occupied, 0.05, 0.0, 0.0, x, y, yaw + ANGLES, 8.0)
            cls.scans.publish(scan)
            time.sleep(0.05)

    def wait_for(self, what):
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            if what():
                return
            time.sleep(0.05)
        self.fail("waited in vain")

    def ask_for_updates_until(self, what):
        def asked():
            rospy.ServiceProxy("request_nomotion_update", Empty)()
            time.sleep(0.1)
            return what()
        self.wait_for(asked)

    def is_at(self, pose, far=0.15):
        message = self.seen.get("amcl_pose")
        return message and np.abs(poses.relative(pose, pose_of(message.pose.pose))).max() < far

    def tell(self, pose, frame="map", stamp=None):
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.header.stamp = frame, stamp or rospy.Time.now()
        message.pose.pose = pose_message(pose)
        message.pose.covariance = np.diag([0.01, 0.01, 0, 0, 0, 0.01]).ravel().tolist()
        self.told.publish(message)
        return message

    def test_1_found_near_where_the_parameters_say(self):
        self.ask_for_updates_until(lambda: self.is_at(TRUTH))
        message = self.seen["amcl_pose"]
        self.assertEqual(message.header.frame_id, "map")
        self.assertGreater(message.pose.covariance[0], 0)
        cloud = self.seen["particlecloud"]
        self.assertGreaterEqual(len(cloud.poses), 200)
        self.assertLess(abs(pose_of(cloud.poses[0])[0] - TRUTH[0]), 1.0)

    def test_2_the_transform_puts_odometry_onto_the_map_ahead_of_time(self):
        self.ask_for_updates_until(lambda: self.is_at(TRUTH))
        self.wait_for(lambda: self.buffer.can_transform("map", "base_link", rospy.Time(0)))
        self.wait_for(lambda: self.buffer.get_latest_common_time("map", "odom")
                      > self.buffer.get_latest_common_time("odom", "base_link"))
        whole = self.buffer.lookup_transform("map", "base_link", rospy.Time(0)).transform
        self.assertLess(np.hypot(whole.translation.x - 2.2, whole.translation.y - 1.7), 0.15)

    def test_3_the_pose_is_saved_for_the_next_start(self):
        self.wait_for(lambda: abs(rospy.get_param("/amcl/initial_pose_x") - 2.2) < 0.15)
        self.assertLess(rospy.get_param("/amcl/initial_cov_xx"), 0.25)

    def test_4_a_pose_of_the_map_is_taken_and_one_of_another_frame_is_not(self):
        self.tell((4.0, 2.0, 0.0), frame="odom")
        time.sleep(0.5)
        self.assertTrue(self.is_at(TRUTH))
        self.tell((4.0, 2.0, 0.0))
        self.wait_for(lambda: self.is_at((4.0, 2.0, 0.0), 0.3))
        self.tell(TRUTH)
        self.ask_for_updates_until(lambda: self.is_at(TRUTH))

    def test_5_a_pose_of_the_past_is_moved_by_the_odometry(self):
        cls = type(self)
        then = rospy.Time.now()
        self.wait_for(lambda: self.buffer.can_transform("odom", "base_link", then))
        step = np.array([0.5, 0.0, 0.4])
        cls.truth, cls.odometry = poses.compose(TRUTH, step), poses.compose(ODOMETRY, step)
        time.sleep(0.3)
        self.tell(TRUTH, stamp=then)
        self.wait_for(lambda: self.is_at(cls.truth))

    def test_6_a_map_is_set_with_a_pose(self):
        request = self.tell(type(self).truth)
        answer = rospy.ServiceProxy("set_map", SetMap)(type(self).map_message(), request)
        self.assertTrue(answer.success)
        self.ask_for_updates_until(lambda: self.is_at(type(self).truth))

    def test_7_found_from_anywhere(self):
        rospy.ServiceProxy("global_localization", Empty)()
        self.ask_for_updates_until(lambda: self.is_at(type(self).truth))

    def test_8_settings_change_and_come_back(self):
        client = dynamic_reconfigure.client.Client("amcl", timeout=LIMIT)
        changed = client.update_configuration({"laser_model_type": "likelihood_field_prob",
                                               "max_particles": 700})
        self.assertEqual(changed["max_particles"], 700)
        self.tell(type(self).truth)
        self.ask_for_updates_until(lambda: self.is_at(type(self).truth))
        back = client.update_configuration({"restore_defaults": True})
        self.assertEqual((back["max_particles"], back["laser_model_type"]),
                         (2000, "likelihood_field"))
        self.assertFalse(back["restore_defaults"])

    def test_9_a_world_that_began_anew_put_the_robot_where_the_odometry_says(self):
        cls = type(self)
        self.tell(cls.truth)
        self.ask_for_updates_until(lambda: self.is_at(cls.truth))
        step = poses.relative(cls.truth, (4.5, 0.6, 3.0))
        cls.truth, cls.odometry = poses.compose(cls.truth, step), poses.compose(cls.odometry, step)
        cls.behind = 100
        self.ask_for_updates_until(lambda: self.is_at(cls.truth))


if __name__ == "__main__":
    rostest.rosrun("amcl", "amcl_story", AmclStory)

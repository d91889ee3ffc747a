"""Several burgers at once: topics, frames and commands keep apart, and vanish with their robot."""

import unittest

import rospy
from contracts import LIMIT, wait_until
from gazebo_msgs.srv import DeleteModel, GetModelState, SpawnModel
from geometry_msgs.msg import Pose, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import LaserScan


def service(name, kind):
    rospy.wait_for_service(f"/gazebo/{name}", LIMIT)
    return rospy.ServiceProxy(f"/gazebo/{name}", kind)


def topics():
    return [name for name, _ in rospy.get_published_topics()]


class Robots(unittest.TestCase):
    def setUp(self):
        self.log = []
        self.rosout = rospy.Subscriber("/rosout", Log, lambda msg: self.log.append(msg.msg))
        wait_until(self.rosout.get_num_connections, "rosout")

    def tearDown(self):
        for name in ("one", "two", "three"):
            service("delete_model", DeleteModel)(name)
        self.rosout.unregister()

    def spawn(self, name, namespace, y):
        pose = Pose()
        pose.position.y = y
        answer = service("spawn_urdf_model", SpawnModel)(
            name, rospy.get_param("robot_description"), namespace, pose, "")
        self.assertTrue(answer.success, answer.status_message)

    def send_forward(self, topic):
        command = rospy.Publisher(topic, Twist, queue_size=1, latch=True)
        self.addCleanup(command.unregister)
        forward = Twist()
        forward.linear.x = 0.2
        command.publish(forward)

    def x_of(self, name):
        return service("get_model_state", GetModelState)(name, "").pose.position.x

    def test_namespaces_keep_topics_and_frames_apart(self):
        self.spawn("one", "/r1", 0.0)
        self.spawn("two", "/r2/", 1.0)
        one = rospy.wait_for_message("/r1/odom", Odometry, LIMIT)
        two = rospy.wait_for_message("/r2/odom", Odometry, LIMIT)
        self.assertEqual((one.header.frame_id, one.child_frame_id), ("odom", "base_footprint"))
        self.assertEqual((two.header.frame_id, two.child_frame_id),
                         ("second/odom", "second/base_footprint"))
        self.assertAlmostEqual(two.pose.pose.position.y, 1.0, places=2)
        scan = rospy.wait_for_message("/r2/scan", LaserScan, LIMIT)
        self.assertEqual(scan.header.frame_id, "second/base_scan")

    def test_a_command_moves_its_robot_only(self):
        self.spawn("one", "/r1", 0.0)
        self.spawn("two", "/r2", 1.0)
        self.send_forward("/r1/cmd_vel")
        wait_until(lambda: self.x_of("one") > 0.1, "the first one's move")
        self.assertLess(abs(self.x_of("two")), 0.005)

    def test_two_robots_in_one_namespace_are_a_warning_and_both_drive(self):
        self.spawn("one", "/r1", 0.0)
        self.spawn("three", "/r1", 1.0)
        wait_until(lambda: any("/r1/imu_service is not offered" in line for line in self.log),
                   "a warning")
        self.send_forward("/r1/cmd_vel")
        wait_until(lambda: min(self.x_of("one"), self.x_of("three")) > 0.1, "both moves")

    def test_topics_vanish_with_the_robot(self):
        self.spawn("one", "/r1", 0.0)
        self.assertIn("/r1/odom", topics())
        service("delete_model", DeleteModel)("one")
        wait_until(lambda: not [name for name in topics() if name.startswith("/r1")], "no topics")

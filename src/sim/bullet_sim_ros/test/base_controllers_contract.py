#!/usr/bin/env python3
"""Controllers of bases over ROS: commands, limits, time-out, odometry, transforms, changes."""

import math
import unittest

import rospy
import rostest
import tf2_ros
from contracts import Manager, Rosout, pass_time, truth, turned, wait_until, yaw_of
from control_msgs.msg import JointTrajectoryControllerState
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from nav_msgs.msg import Odometry

STEADY = 0.8  # s, simulated: the ramp and the window of the published speeds are over


class Base:
    """Sends commands 50 times a second, as a driver would, and hears the odometry."""

    def __init__(self, name):
        self.name = name
        self.manager = Manager(name)
        self.manager.run("drive")
        self.odometry = []
        self._command = Twist()
        self._topic = rospy.Publisher(f"/{name}/drive/cmd_vel", Twist, queue_size=1)
        rospy.Subscriber(f"/{name}/drive/odom", Odometry, self.odometry.append, queue_size=100)
        wait_until(self._topic.get_num_connections, f"{name} listens")
        wait_until(lambda: self.odometry, f"odometry of {name}")
        self._timer = None

    def send(self, forward, turning):
        self._command.linear.x, self._command.angular.z = forward, turning
        if self._timer is None:
            self._timer = rospy.Timer(rospy.Duration(0.02),
                                      lambda _event: self._topic.publish(self._command))

    def send_once(self, forward, turning):
        self._topic.publish(Twist(Vector3(forward, 0, 0), Vector3(0, 0, turning)))

    def fall_silent(self):
        if self._timer is not None:
            self._timer.shutdown()
            self._timer = None

    def come_to_rest(self):
        self.send(0.0, 0.0)
        pass_time(0.3)
        wait_until(lambda: max(map(abs, truth(self.name)[3:])) < 0.005, f"{self.name} stands")
        self.fall_silent()
        pass_time(0.1)

    def pose(self):
        pose = self.odometry[-1].pose.pose
        return pose.position.x, pose.position.y, yaw_of(pose.orientation)

    def speeds(self):
        twist = self.odometry[-1].twist.twist
        return twist.linear.x, twist.linear.y, twist.angular.z


class BaseControllers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bases = {name: Base(name) for name in ("diff_base", "tricycle", "four_wheels")}
        cls.diff = cls.bases["diff_base"]

    def setUp(self):
        for base in self.bases.values():
            base.manager.run("drive")

    def tearDown(self):
        for base in self.bases.values():
            base.come_to_rest()

    def test_a_metre_forward_and_odometry_within_one_percent(self):
        # conforms: controllers/diff_drive_controller/DiffDriveController
        base = self.diff
        x, y, _ = base.pose()
        true_x, true_y, *_ = truth(base.name)
        base.send(0.5, 0.0)
        wait_until(lambda: math.dist(base.pose()[:2], (x, y)) > 0.9, "0.9 m by odometry")
        self.assertAlmostEqual(truth(base.name)[3], 0.5, delta=0.005)
        self.assertAlmostEqual(base.speeds()[0], 0.5, delta=0.005)
        base.come_to_rest()
        counted = math.dist(base.pose()[:2], (x, y))
        driven = math.dist(truth(base.name)[:2], (true_x, true_y))
        self.assertGreater(driven, 0.9)
        self.assertAlmostEqual(counted / driven, 1.0, delta=0.01)

    def test_a_turn_in_place_within_two_percent(self):
        base = self.diff
        before, true_before = base.pose()[2], truth(base.name)[2]
        base.send(0.0, 1.0)
        pass_time(2.0)
        self.assertAlmostEqual(base.speeds()[2], 1.0, delta=0.02)
        base.come_to_rest()
        counted, driven = turned(before, base.pose()[2]), turned(true_before, truth(base.name)[2])
        self.assertGreater(abs(driven), 1.0)
        self.assertAlmostEqual(counted / driven, 1.0, delta=0.02)

    def test_frames_covariances_and_the_transform(self):
        message = self.diff.odometry[-1]
        self.assertEqual((message.header.frame_id, message.child_frame_id), ("odom", "base_link"))
        self.assertEqual(message.pose.covariance[::7], (1e-3, 1e-3, 1e6, 1e6, 1e6, 0.03))
        self.assertEqual(message.twist.covariance[::7], (2e-3, 1e-3, 1e6, 1e6, 1e6, 0.03))
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        wait_until(lambda: buffer.can_transform("odom", "base_link", rospy.Time()), "odom on tf")
        transform = buffer.lookup_transform("odom", "base_link", rospy.Time()).transform
        self.assertAlmostEqual(transform.translation.x, self.diff.pose()[0], delta=0.01)
        listener.unregister()

    def test_without_commands_it_brakes_after_the_time_out(self):
        base = self.diff
        base.send(0.5, 0.0)
        pass_time(STEADY)
        base.fall_silent()
        pass_time(0.25 + 0.25 + 0.2)  # time-out, ramp, delays
        self.assertAlmostEqual(truth(base.name)[3], 0.0, delta=0.01)

    def test_speeds_grow_as_the_limits_say(self):
        base, limited = self.diff, []
        subscriber = rospy.Subscriber(f"/{base.name}/drive/cmd_vel_out", TwistStamped,
                                      limited.append, queue_size=1000)
        wait_until(lambda: limited, "cmd_vel_out")
        base.send(0.6, 0.0)
        wait_until(lambda: limited[-1].twist.linear.x >= 0.6, "the wanted speed")
        subscriber.unregister()
        ramp = [msg for msg in limited if 0.01 < msg.twist.linear.x < 0.59]
        took = (ramp[-1].header.stamp - ramp[0].header.stamp).to_sec()
        rise = ramp[-1].twist.linear.x - ramp[0].twist.linear.x
        self.assertAlmostEqual(rise / took, 2.0, delta=0.05)

    def test_a_command_that_is_no_number_is_ignored(self):
        base = self.diff
        base.send_once(math.nan, 0.0)
        base.send_once(0.0, math.inf)
        pass_time(0.3)
        self.assertAlmostEqual(truth(base.name)[3], 0.0, delta=0.005)
        self.assertTrue(all(map(math.isfinite, base.pose())))

    def test_wheel_states(self):
        states = []
        subscriber = rospy.Subscriber("/diff_base/drive/wheel_joint_controller_state",
                                      JointTrajectoryControllerState, states.append, queue_size=1)
        self.diff.send(0.5, 0.0)
        pass_time(STEADY)
        wait_until(lambda: states, "states")
        state = states[-1]
        subscriber.unregister()
        self.assertEqual(state.joint_names, ["left_wheel_joint", "right_wheel_joint"])
        for wanted, actual in zip(state.desired.velocities, state.actual.velocities, strict=True):
            self.assertAlmostEqual(wanted, 10.0, places=6)
            self.assertAlmostEqual(actual, 10.0, delta=0.1)

    def test_parameters_change_at_run_time(self):
        client = Client("/diff_base/drive", timeout=60)
        base = self.diff
        client.update_configuration({"publish_rate": 10.0, "left_wheel_radius_multiplier": 0.5,
                                     "right_wheel_radius_multiplier": 0.5})
        base.send(0.2, 0.0)
        pass_time(STEADY)
        self.assertAlmostEqual(truth(base.name)[3], 0.4, delta=0.02)
        stamps = [msg.header.stamp.to_sec() for msg in base.odometry[-4:]]
        self.assertAlmostEqual((stamps[-1] - stamps[0]) / 3, 0.1, delta=0.005)
        client.update_configuration({"publish_rate": 50.0, "left_wheel_radius_multiplier": 1.0,
                                     "right_wheel_radius_multiplier": 1.0})
        client.close()

    def test_a_stopped_controller_brakes_and_obeys_nobody(self):
        base = self.diff
        base.send(0.5, 0.0)
        pass_time(STEADY)
        where = base.pose()
        rosout = Rosout()
        self.assertTrue(base.manager.switch(stop=["drive"]))
        rosout.wait_for("cmd_vel: Can't accept new commands. Controller is not running.")
        pass_time(0.5)
        self.assertAlmostEqual(truth(base.name)[3], 0.0, delta=0.01)
        base.fall_silent()
        self.assertTrue(base.manager.switch(start=["drive"]))
        pass_time(0.2)
        self.assertLess(math.dist(base.pose()[:2], where[:2]), 0.2)  # odometry goes on

    def test_a_controller_that_was_loaded_again_begins_at_zero(self):
        base = self.bases["tricycle"]
        base.send(0.4, 0.0)
        wait_until(lambda: base.pose()[0] > 0.1, "some way")
        base.come_to_rest()
        base.manager.reload("drive")
        wait_until(lambda: abs(base.pose()[0]) < 0.005, "odometry at zero")
        base.send(0.4, 0.0)
        wait_until(lambda: base.pose()[0] > 0.1, "some way again")

    def test_ackermann_drives_the_circle_of_its_angle(self):
        # conforms: controllers/ackermann_steering_controller/AckermannSteeringController
        base = self.bases["tricycle"]
        base.send(0.5, 0.3)
        pass_time(STEADY + 0.7)
        _, _, _, forward, _, yaw_rate = truth(base.name)
        radius = 0.4 / math.tan(0.3)
        self.assertAlmostEqual(forward, 0.5, delta=0.02)
        self.assertAlmostEqual(forward / yaw_rate, radius, delta=0.03 * radius)
        counted = base.speeds()
        self.assertAlmostEqual(counted[0] / counted[2], radius, delta=0.03 * radius)

    def test_four_wheels_drive_the_twist(self):
        # conforms: controllers/four_wheel_steering_controller/FourWheelSteeringController
        base = self.bases["four_wheels"]
        base.send(0.4, 0.5)
        pass_time(STEADY + 0.7)
        for spoken in (truth(base.name)[3:], base.speeds()):
            self.assertAlmostEqual(spoken[0], 0.4, delta=0.012)
            self.assertAlmostEqual(spoken[1], 0.0, delta=0.012)
            self.assertAlmostEqual(spoken[2], 0.5, delta=0.015)

    def test_bad_parameters_do_not_load(self):
        good = rospy.get_param("/diff_base/drive")
        for number, change in enumerate((
                {"left_wheel": "nobody"}, {"left_wheel": ["left_wheel_joint", "right_wheel_joint"]},
                {"pose_covariance_diagonal": [1.0]}, {"wheel_radius": 0.0},
                {"publish_rate": "often"})):
            rospy.set_param(f"/diff_base/bad{number}", {**good, **change})
            self.assertFalse(self.diff.manager.load(f"bad{number}"), change)


if __name__ == "__main__":
    rospy.init_node("base_controllers_contract")
    rostest.rosrun("bullet_sim_ros", "base_controllers", BaseControllers)

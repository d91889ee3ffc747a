#!/usr/bin/env python3
"""What motor_control tells the joint controllers, and each way in which it stops the car."""

import math
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from ackermann_msgs.msg import AckermannDriveStamped
from dynamic_reconfigure.client import Client
from fake_controllers import LIMIT, FakeControllers, wait_until
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Log
from std_msgs.msg import Bool

NODE = ("rosrun", "car_control", "motor_control.py")
LENGTH, HALF_TRACK, RADIUS = 0.335, 0.115, 0.05  # m, of config/car_control.yaml


def twist(speed, angle=0.0):
    message = Twist()
    message.linear.x, message.angular.z = speed, angle
    return message


def on_a_circle(speed, radius):
    """Wheels in rad/s and hinges in rad of a car on a circle to the left, by plain geometry."""
    turn = speed / radius  # rad/s
    left, right = radius - HALF_TRACK, radius + HALF_TRACK
    wheels = [left, right, math.hypot(left, LENGTH), math.hypot(right, LENGTH)]
    hinges = [math.atan(LENGTH / left), math.atan(LENGTH / right)]
    return [turn * wheel / RADIUS for wheel in wheels], hinges


class Sender:
    """Publishes one message on a topic again and again, as a keyboard node does."""

    def __init__(self, topic, kind):
        self.publisher = rospy.Publisher(topic, kind, queue_size=1)
        wait_until(lambda: self.publisher.get_num_connections() >= 3, f"listeners on {topic}")
        self.message, self.sent_at = None, 0.0  # s
        self.timer = rospy.Timer(rospy.Duration(0.05), self.send)

    def send(self, _event):
        if self.message is not None:
            self.sent_at = time.monotonic()
            self.publisher.publish(self.message)


class MotorControlStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.car, cls.page = FakeControllers(), FakeControllers("/page")
        cls.answers = FakeControllers("/answers")
        cls.twists = Sender("motor_output", Twist)
        cls.ackermanns = Sender("ackermann_cmd", AckermannDriveStamped)
        cls.stops = rospy.Publisher("estop", Bool, queue_size=1)
        wait_until(lambda: cls.stops.get_num_connections() >= 3, "listeners on estop")
        cls.said = []
        cls.log = rospy.Subscriber("/rosout", Log, lambda log: cls.said.append(log.msg))
        cls.settings = Client("motor_control", timeout=LIMIT)

    def tearDown(self):
        self.twists.message = self.ackermanns.message = None
        self.settings.update_configuration({"timeout": 0.5, "max_speed": 5.0})
        wait_until(self.car.stand, "standing after the test")

    def test_each_wheel_has_its_own_speed_and_each_hinge_its_own_angle(self):
        self.twists.message = twist(2.0, math.atan(LENGTH / 1.5))
        self.car.wait_for(*on_a_circle(2.0, 1.5), "a circle of 1.5 m to the left")

    def test_the_tutorials_law(self):
        self.twists.message = twist(1.5, -0.2)
        self.page.wait_for([12.0] * 4, [-0.2] * 2, "8 rad/s for each unit, equal angles")

    def test_ackermann_messages(self):
        message = AckermannDriveStamped()
        message.drive.speed, message.drive.steering_angle = -1.0, math.atan(LENGTH / 2.0)
        self.ackermanns.message = message
        self.car.wait_for(*on_a_circle(-1.0, 2.0), "backwards on a circle")

    def test_speed_and_angle_have_limits(self):
        self.twists.message = twist(99.0, 9.0)
        self.car.wait_for(*on_a_circle(5.0, LENGTH / math.tan(0.34)), "5 m/s and 0.34 rad")

    def test_it_stops_when_commands_end_though_the_sender_lives(self):
        self.twists.message = twist(1.0, 0.2)
        self.car.wait_for(*on_a_circle(1.0, LENGTH / math.tan(0.2)), "1 m/s and 0.2 rad")
        self.car.told.clear()
        self.twists.message = None
        wait_until(self.car.stand, "standing")
        first_zero = next(when for when, _name, value in self.car.told if value == 0)
        self.assertGreater(first_zero - self.twists.sent_at, 0.4)  # not before the time-out
        self.assertGreater(min(self.car.hinges()), 0.1)  # the front wheels stay where they are

    def test_it_stops_at_once_when_the_sender_is_killed(self):
        self.settings.update_configuration({"timeout": 10.0})
        command = ["rostopic", "pub", "-r", "20", "/motor_output", "geometry_msgs/Twist",
                   "{linear: {x: 1.0}}"]
        publisher = self.twists.publisher
        publisher.unregister()  # else there would be another sender
        sender = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        try:
            self.car.wait_for_speed(1.0, "driving by rostopic pub")
            sender.kill()
            wait_until(self.car.stand, "standing before the time-out", limit=9.0)
        finally:
            sender.kill()
            sender.wait()
            self.twists.publisher = rospy.Publisher("motor_output", Twist, queue_size=1)
            wait_until(lambda: self.twists.publisher.get_num_connections() >= 3, "listeners again")

    def test_what_is_no_number_is_refused(self):
        self.twists.message = twist(1.0)
        self.car.wait_for_speed(1.0, "driving")
        self.car.told.clear()
        self.twists.message = twist(math.nan, 0.1)
        words = "refused a command on motor_output: speed nan"
        wait_until(lambda: any(words in line for line in self.said), words)
        wait_until(self.car.stand, "standing: no command that counts comes any more")
        self.assertEqual({value for _when, _name, value in self.car.told}, {0.0, 20.0})

    def test_one_that_starts_says_that_there_is_no_emergency_stop(self):
        node = subprocess.Popen([*NODE, "__ns:=fresh"])
        try:
            self.assertFalse(rospy.wait_for_message("/fresh/estop_state", Bool, LIMIT).data)
        finally:
            node.terminate()
            node.wait()

    def test_emergency_stop_wins_until_it_is_over(self):
        self.twists.message = twist(2.0)
        self.car.wait_for_speed(2.0, "driving")
        self.stops.publish(True)
        wait_until(self.car.stand, "standing")
        self.assertTrue(rospy.wait_for_message("estop_state", Bool, LIMIT).data)  # for later nodes
        release = "To release it, type: rostopic pub -1 /estop std_msgs/Bool false"
        wait_until(lambda: any(release in line for line in self.said), release)
        self.car.told.clear()
        wait_until(lambda: len(self.car.told) > 120, "some commands more")
        self.assertEqual({value for _when, _name, value in self.car.told}, {0.0})
        self.stops.publish(False)
        self.car.wait_for_speed(2.0, "driving again")

    def test_emergency_stop_needs_no_repeated_commands(self):
        # This node repeats nothing, and its time-out is far away.
        Client("motor_control_answers", timeout=LIMIT).update_configuration({"timeout": 10.0})
        self.twists.publisher.publish(twist(2.0))
        self.answers.wait_for_speed(2.0, "driving")
        self.stops.publish(True)
        wait_until(self.answers.stand, "standing before the time-out", limit=9.0)
        self.stops.publish(False)

    def test_settings_change_while_it_runs(self):
        self.twists.message = twist(3.0)
        self.car.wait_for_speed(3.0, "driving")
        now = self.settings.update_configuration({"max_speed": 1.5})
        self.assertEqual(now["max_speed"], 1.5)
        self.car.wait_for_speed(1.5, "slower")
        now = self.settings.update_configuration({"max_speed": math.nan})
        self.assertEqual(now["max_speed"], 1.5)
        self.assertEqual(self.settings.get_configuration()["max_speed"], 1.5)

    def test_ctrl_c_leaves_the_car_standing(self):
        other = FakeControllers("/other", runs=False)
        command = [*NODE, "__name:=other", "_namespace:=/other", "_ackermann:=true",
                   "_rate_hz:=0", "_timeout:=10"]
        node = subprocess.Popen(command)
        try:
            wait_until(lambda: other.subscribers[0].get_num_connections(), "the other node")
            self.twists.message = twist(1.0)
            other.wait_for_speed(1.0, "driving")
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(LIMIT), 0)
        finally:
            node.kill()
        wait_until(other.stand, "standing")

    def test_a_wrong_parameter_is_one_line(self):
        done = subprocess.run([*NODE, "_timeout:=-1"], capture_output=True, text=True,
                              timeout=LIMIT, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("'timeout' must be a number from 0.02 to 10, not -1", done.stderr)


if __name__ == "__main__":
    rospy.init_node("motor_control_story")
    rostest.rosrun("car_control", "motor_control_story", MotorControlStory, sys.argv)

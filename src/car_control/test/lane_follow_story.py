#!/usr/bin/env python3
"""lane_follow, its baseline and show.py before a drawn road: commands, stops, windows."""

import math
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

import rospy
import rostest
from car_control.lane.line_finding import LaneSettings
from drawn_road import track
from dynamic_reconfigure.client import Client
from fake_controllers import LIMIT, wait_until
from geometry_msgs.msg import Twist
from node_basics.settings import load_settings
from sensor_msgs.msg import Image
from stand_in_camera import StandInCamera
from std_msgs.msg import Bool

CONFIG = Path(__file__).resolve().parents[1] / "config" / "lane_follow.yaml"
OVAL = track((4, -1.5, 1.5), (4, 1.5, 1.5), (-4, 1.5, 1.5), (-4, -1.5, 1.5))


class Commands:
    """What came on a topic last."""

    def __init__(self, topic):
        self.last, self.number = (math.nan, math.nan), 0
        self.subscriber = rospy.Subscriber(topic, Twist, self.keep)

    def keep(self, message):
        self.last, self.number = (message.linear.x, message.angular.z), self.number + 1

    def wait_until(self, wanted, what):
        try:
            wait_until(lambda: wanted(*self.last), what)
        except AssertionError as error:
            raise AssertionError(f"{error}; the last command was {self.last}") from error


def stands(speed, _angle):
    return speed == 0


class LaneFollowStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.camera = StandInCamera(OVAL, load_settings(LaneSettings, CONFIG))
        cls.commands, cls.baseline = Commands("motor_output"), Commands("motor_output_p")
        wait_until(lambda: cls.commands.number and cls.baseline.number, "commands from both")

    def setUp(self):
        self.camera.sends, self.camera.beside = True, 0.0
        self.commands.wait_until(lambda v, a: v > 1 and abs(a) < 0.1, "driving straight on")

    def test_both_steer_back_to_the_line(self):
        for beside in (0.1, -0.1):
            self.camera.beside = beside
            for commands in (self.commands, self.baseline):
                commands.wait_until(lambda _v, a, s=beside: a * s < -0.003, "steering to the line")

    def test_one_command_an_image(self):
        images = []
        watch = rospy.Subscriber("camera/image_raw", Image, images.append, queue_size=100)
        wait_until(lambda: images, "images")

        def commands_for_60():
            before = self.commands.number
            images.clear()
            wait_until(lambda: len(images) >= 60, "60 images")
            return self.commands.number - before

        # A busy node misses some; it has several tries.
        wait_until(lambda: abs(commands_for_60() - 60) <= 10, "60 commands for 60 images")
        watch.unregister()

    def test_a_lost_line_is_searched_and_then_given_up_and_found_again(self):
        self.camera.beside = None
        self.commands.wait_until(lambda v, a: v == 0.5 and abs(a) == 0.34, "searching")
        self.commands.wait_until(stands, "standing")
        self.baseline.wait_until(stands, "the baseline standing")

    def test_it_stands_still_without_images(self):
        self.camera.sends = False
        self.commands.wait_until(stands, "standing")

    def test_a_message_that_is_no_picture_ends_nothing(self):
        self.camera.sends = False
        self.commands.wait_until(stands, "standing")
        self.camera.publisher.publish(Image(height=360, width=640, encoding="bgr8", data=b"few"))
        time.sleep(1.0)  # nobody says that it has come
        self.camera.sends = True
        self.commands.wait_until(lambda v, _a: v > 1, "driving")
        rospy.wait_for_message("/show/windows/SHOW", Image, LIMIT)

    def test_gains_change_while_it_runs(self):
        self.camera.beside = 0.05
        self.commands.wait_until(lambda _v, a: -0.3 < a < 0, "steering")
        client = Client("lane_follow", timeout=LIMIT)
        client.update_configuration({"kp": 50.0})
        self.commands.wait_until(lambda _v, a: a == -0.34, "steering as hard as it can")
        client.update_configuration({"kp": 2.0, "max_speed": 0.0})
        self.commands.wait_until(stands, "standing at a highest speed of 0")
        client.update_configuration({"max_speed": 2.2})

    def test_what_it_sees_is_drawn(self):
        picture = rospy.wait_for_message("/lane_follow/picture", Image, LIMIT)
        self.assertEqual((picture.width, picture.height), (640, 360))
        marked = sum(picture.data[i : i + 3] == b"\0\0\xff" for i in range(0, len(picture.data), 3))
        self.assertGreater(marked, 500)

    def test_show_shows_the_camera(self):
        seen = self.camera.seen[1].tobytes()
        wait_until(lambda: rospy.wait_for_message("/show/windows/SHOW", Image, LIMIT).data == seen,
                   "the camera's picture")

    def test_an_emergency_stop_is_said_with_what_releases_it(self):
        stop = rospy.Publisher("held/estop_state", Bool, queue_size=1, latch=True)
        stop.publish(True)
        node = subprocess.Popen(
            ["rosrun", "car_control", "lane_follow.py", "__ns:=held", "__name:=follow",
             "camera/image_raw:=/camera/image_raw"], text=True, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, env={**os.environ, "PYTHONUNBUFFERED": "1"})
        try:
            lines = (line for line in node.stdout if "emergency stop" in line)
            line = next(lines)
            self.assertIn("the emergency stop is on, and the car stands", line)
            self.assertIn("rostopic pub -1 /held/estop std_msgs/Bool false", line)
            stop.publish(False)
            self.assertIn("the emergency stop is over", next(lines))
        finally:
            node.kill()
            node.wait()
            node.stdout.close()
            stop.unregister()

    def test_ctrl_c_leaves_the_car_standing(self):
        other = Commands("other_output")
        renamed = ["__name:=other", "motor_output:=other_output"]
        node = subprocess.Popen(["rosrun", "car_control", "lane_follow.py", *renamed])
        try:
            other.wait_until(lambda v, _a: v > 1, "driving")
            node.send_signal(signal.SIGINT)
            self.assertEqual(node.wait(LIMIT), 0)
        finally:
            node.kill()
        other.wait_until(stands, "standing")


if __name__ == "__main__":
    rospy.init_node("lane_follow_test")
    rostest.rosrun("car_control", "lane_follow_story", LaneFollowStory, sys.argv)

#!/usr/bin/env python3
"""The contracts of the course with the waffle, one after another in one simulator."""

import subprocess
import unittest

import rospy
import rostest
from contracts import Rosout
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image, LaserScan
from waffle_contract import Waffle  # noqa: F401, rostest finds it by this module's name

LIMIT = 60.0  # s


class TopicFaults(unittest.TestCase):
    """What the simulator says of commands and images that do not meet, with other nodes."""

    def setUp(self):
        self.nodes = []
        rospy.wait_for_message("/scan", LaserScan, LIMIT)  # the robot is there

    def tearDown(self):
        for node in self.nodes:
            node.terminate()
            node.wait(LIMIT)

    def drive(self, name):
        self.nodes.append(subprocess.Popen([
            "rostopic", "pub", "-r", "10", "/cmd_vel", "geometry_msgs/Twist", "{}",
            f"__name:={name}"]))

    def test_each_is_said_with_who_and_what_is_meant(self):
        rosout, me = Rosout(), rospy.get_name()
        wrong = rospy.Publisher("/robot/cmd_vel", Twist, queue_size=1)
        blind = rospy.Subscriber("/camera/image_raw", Image)
        rosout.wait_for(f"{me} sends commands on /robot/cmd_vel, but nobody hears them there; "
                        "the robot listens on /cmd_vel")
        rosout.wait_for(f"{me} waits for sensor_msgs/Image on /camera/image_raw, but nobody "
                        "publishes it; the simulator publishes /camera/rgb/image_raw")
        wrong.unregister()
        blind.unregister()
        self.drive("teleop")
        self.drive("follower")
        rosout.wait_for("/follower, /teleop send commands on /cmd_vel at the same time")
        said = [line for line in rosout.lines if "commands on" in line or "waits for" in line]
        self.assertEqual(len(said), 3, said)


if __name__ == "__main__":
    rospy.init_node("course_contract")
    rostest.rosrun("bullet_sim_ros", "course", "__main__")

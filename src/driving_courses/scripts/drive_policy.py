#!/usr/bin/env python3
"""Drives a ROS course by a policy that was learned in its environment: images in, commands out."""

import sys
import time

import cv_bridge
import rospy
from driving_courses.course import load_course
from driving_courses.errors import CourseError
from driving_courses.features import find_features, shrink
from driving_courses.policy import load_policy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image


class PolicyDriver:
    """A command for each image. A steering angle goes into angular.z, as motor_control takes it."""

    def __init__(self, path):
        self.policy = load_policy(path)
        self.features = load_course(self.policy.course).features
        self.bridge = cv_bridge.CvBridge()
        self.commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.images = rospy.Subscriber("image", Image, self.take, queue_size=1, buff_size=2**24)

    def take(self, message):
        rgb = shrink(self.bridge.imgmsg_to_cv2(message, desired_encoding="rgb8"), self.features)
        command = Twist()
        command.linear.x, command.angular.z = self.policy.act(find_features(rgb, self.features))
        self.commands.publish(command)

    def stop(self):
        """The robot may go on by its last command, so that has to be to stand."""
        self.images.unregister()
        for _ in range(3):  # sending takes a moment, and an image may still be at work
            self.commands.publish(Twist())
            time.sleep(0.1)  # s, on the wall: simulated time may stand still


def main():
    rospy.init_node("drive_policy")
    try:
        driver = PolicyDriver(rospy.get_param("~policy"))
    except (KeyError, CourseError) as error:
        rospy.logfatal("%s", f"parameter {error} is missing" if isinstance(error, KeyError)
                       else error)
        sys.exit(1)
    rospy.on_shutdown(driver.stop)
    rospy.spin()


if __name__ == "__main__":
    main()

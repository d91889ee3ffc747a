#!/usr/bin/env python3
"""The simplest lane follower, as a baseline: plain P at a constant speed, blind to bends.

Finds the yellow line in a few rows of the image, as the line follower tutorials do, and steers by
its distance from the middle.  最简单的巡线：只有比例控制，速度不变，用来作比较。
"""

import time

import cv2
import cv_bridge
import numpy
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
LOWER_YELLOW = numpy.array([20, 43, 46])
UPPER_YELLOW = numpy.array([35, 255, 255])
BAND_TOP, BAND_HEIGHT = 5 / 6, 1 / 54  # share of the image's height
SPEED = 1.5  # m/s
GAIN = 0.6  # rad if the line is at the image's edge
MAX_ANGLE = 0.34  # rad


def find_line(image):
    """The line's place: -1 is the image's left edge, 1 the right edge; None: no line."""
    height, width = image.shape[:2]
    top = int(BAND_TOP * height)
    band = image[top : top + max(1, int(BAND_HEIGHT * height))]
    hsv = cv2.cvtColor(band, cv2.COLOR_BGR2HSV)
    moments = cv2.moments(cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW), binaryImage=True)
    return 2 * moments["m10"] / moments["m00"] / width - 1 if moments["m00"] else None


def steer(err):
    """Steering angle in rad, left positive, for a line at err.  转向角，左为正。"""
    return max(-MAX_ANGLE, min(MAX_ANGLE, -GAIN * err))


class LaneFollowP:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        self.motor_pub = rospy.Publisher("motor_output", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        err = find_line(self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8"))
        command = Twist()
        if err is None:
            rospy.logwarn_throttle(2, "line lost, standing still  线丢了，停车")
        else:
            command.linear.x, command.angular.z = SPEED, steer(err)
        self.motor_pub.publish(command)

    def stop(self):
        self.image_sub.unregister()  # else the next image would start the car again
        for _ in range(3):  # sending takes time, and a callback may still be running
            self.motor_pub.publish(Twist())
            time.sleep(0.1)  # s of wall time: simulated time may be paused  用真实时间


def main():
    rospy.init_node("lane_follow_p")
    rospy.on_shutdown(LaneFollowP().stop)
    rospy.spin()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Lesson 3: keep only what is yellow.  第三课：只保留黄色。"""

import cv2
import cv_bridge
import numpy
import rospy
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
LOWER_YELLOW = numpy.array([20, 43, 46])
UPPER_YELLOW = numpy.array([90, 255, 255])


def yellow_mask(image):
    """255 where the BGR image is yellow, 0 elsewhere.  黄色处为 255，其余为 0。"""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    return cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW)


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("showYellowOnly", cv2.WINDOW_NORMAL)
        cv2.namedWindow("masked", cv2.WINDOW_NORMAL)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        # Ask for bgr8: the camera sends rgb8, so red and blue would be swapped.
        # 必须写明 bgr8：相机发来的是 rgb8，否则红蓝颠倒。
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        mask = yellow_mask(image)
        masked = cv2.bitwise_and(image, image, mask=mask)  # black where it is not yellow  非黄为黑
        cv2.imshow("showYellowOnly", mask)
        cv2.imshow("masked", masked)
        cv2.waitKey(3)  # ms


def main():
    rospy.init_node("follower", anonymous=True)
    Follower()
    rospy.spin()


if __name__ == "__main__":
    main()

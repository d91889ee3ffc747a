#!/usr/bin/env python3
"""Exercise white_line: keep only the white line.  练习：只留下白线。"""

import cv2
import cv_bridge
import numpy
import rospy
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
# Yours: these are lesson 3's bounds for yellow.  请修改：这是第三课黄色的上下限
LOWER_WHITE = numpy.array([20, 43, 46])
UPPER_WHITE = numpy.array([90, 255, 255])


def white_mask(image):
    """255 where the BGR image is white, 0 elsewhere.  白色处为 255，其余为 0。"""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    return cv2.inRange(hsv, LOWER_WHITE, UPPER_WHITE)


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("white", cv2.WINDOW_NORMAL)
        rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        cv2.imshow("white", white_mask(self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")))
        cv2.waitKey(3)  # ms


def main():
    rospy.init_node("follower", anonymous=True)
    Follower()
    rospy.spin()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Lesson 4: find where the line is.  第四课：找到线的位置。"""

import cv2
import cv_bridge
import numpy
import rospy
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
LOWER_YELLOW = numpy.array([20, 43, 46])
UPPER_YELLOW = numpy.array([90, 255, 255])
BAND_PX = 20  # number of rows searched  只看这么多行


def yellow_mask(image):
    """255 where the BGR image is yellow, 0 elsewhere.  黄色处为 255，其余为 0。"""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    return cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW)


def band_rows(height):
    """The rows that are searched.  要看的那几行。"""
    top = 3 * height // 4  # //: a row number must be an integer  行号必须是整数
    return slice(top, top + BAND_PX)


def band_mask(image):
    """The yellow mask in these rows, 0 in all others.  只保留这几行的掩膜。"""
    rows = band_rows(image.shape[0])
    mask = numpy.zeros(image.shape[:2], numpy.uint8)
    mask[rows] = yellow_mask(image[rows])
    return mask


def find_line(image):
    """Column and row of the middle of the yellow line, or None.  黄线的中心。"""
    rows = band_rows(image.shape[0])
    moments = cv2.moments(yellow_mask(image[rows]), binaryImage=True)
    if moments["m00"] == 0:
        return None
    column, row = moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]
    return int(column), rows.start + int(row)


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        cv2.namedWindow("findLine", cv2.WINDOW_NORMAL)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        mask = band_mask(image)
        centre = find_line(image)
        if centre is None:
            rospy.logwarn_throttle(2, "no yellow line in sight  看不到黄线")
        else:
            cv2.circle(image, centre, 20, (0, 0, 255), -1)  # a red dot  红点
        cv2.imshow("showImage", image)
        cv2.imshow("findLine", mask)
        cv2.waitKey(3)  # ms


def main():
    rospy.init_node("follower", anonymous=True)
    Follower()
    rospy.spin()


if __name__ == "__main__":
    main()

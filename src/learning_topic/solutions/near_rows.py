#!/usr/bin/env python3
"""Exercise near_rows: use only the near rows.  练习：只看近处。"""

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


def find_line(image):
    """Column and row of the yellow line's middle at 5/6 of the height, or None.  黄线的中心。"""
    top = 5 * image.shape[0] // 6
    moments = cv2.moments(yellow_mask(image[top : top + BAND_PX]), binaryImage=True)
    if moments["m00"] == 0:
        return None
    column, row = moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]
    return int(column), top + int(row)


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        centre = find_line(image)
        if centre:
            cv2.circle(image, centre, 20, (0, 0, 255), -1)  # a red dot  红点
        cv2.imshow("showImage", image)
        cv2.waitKey(3)  # ms


def main():
    rospy.init_node("follower", anonymous=True)
    Follower()
    rospy.spin()


if __name__ == "__main__":
    main()

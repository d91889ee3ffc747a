#!/usr/bin/env python3
"""Exercise shade: shade is not a lane line.  练习：阴影不是车道线。"""

import cv2
import cv_bridge
import rospy
from sensor_msgs.msg import Image

BLOCK_PX = 61  # px, side of the square that a pixel is compared with  与周围这么大的方块比较
SHARE = 0.6  # a line is darker than this share of the mean  线比均值的这个比例还暗


def line_mask(grey):
    """255 where a grey image (rows, columns) may show a dark line, else 0.  可能是线处为 255"""
    mean = cv2.blur(grey, (BLOCK_PX, BLOCK_PX))
    return cv2.compare(grey, cv2.convertScaleAbs(mean, alpha=SHARE), cv2.CMP_LT)


class Looker:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("mask", cv2.WINDOW_NORMAL)
        rospy.Subscriber("camera", Image, self.image_callback, queue_size=1, buff_size=2**24)

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        lower = image[image.shape[0] // 2 :]
        cv2.imshow("mask", line_mask(cv2.cvtColor(lower, cv2.COLOR_BGR2GRAY)))
        cv2.waitKey(3)  # ms


def main():
    rospy.init_node("shade")
    Looker()
    rospy.spin()


if __name__ == "__main__":
    main()

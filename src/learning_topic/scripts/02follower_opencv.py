#!/usr/bin/env python3
"""Lesson 2: show the camera's image with OpenCV.  第二课：用 OpenCV 显示图像。"""

import cv2
import cv_bridge
import rospy
from sensor_msgs.msg import Image


def blue_channel(image):
    """The blue channel of a BGR image, as a grey image.  取出蓝色通道。"""
    return image[:, :, 0]


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        # OpenCV stores colours in the order blue, green, red.  OpenCV 的颜色顺序是蓝、绿、红。
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        cv2.imshow("showImage", blue_channel(image))
        cv2.waitKey(3)  # ms; without it the window stays empty  没有这句窗口不会刷新


def main():
    rospy.init_node("follower", anonymous=True)
    Follower()
    rospy.spin()


if __name__ == "__main__":
    main()

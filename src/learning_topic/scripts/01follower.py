#!/usr/bin/env python3
"""Lesson 1: receive the camera's images.  第一课：接收相机图像。"""

import rospy
from sensor_msgs.msg import Image


def image_callback(msg):
    """Called once for each image.  每来一帧图像调用一次。"""


rospy.init_node("follower")
# The buffer must be larger than one image, or the images received are old ones.
# 缓冲区要大于一帧图像，否则收到的是旧图像。
rospy.Subscriber("camera/rgb/image_raw", Image, image_callback, queue_size=1, buff_size=2**24)
rospy.spin()

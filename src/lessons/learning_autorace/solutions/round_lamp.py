#!/usr/bin/env python3
"""Exercise round_lamp: which lamp is lit, and what is none.  练习：哪盏灯亮着，什么不是灯。"""

import cv2
import cv_bridge
import rospy
from sensor_msgs.msg import Image

# Hue range (0..180) of a lit lamp.  亮着的灯的色相
HUES = {"red": (0, 6), "yellow": (25, 35), "green": (50, 70)}
LEAST = 200, 200  # saturation, value  饱和度、亮度
LEAST_AREA = 60  # px
ROUND = 0.6, 1.6  # width / height  宽高比


def is_lamp(width, height, area):
    """Whether a blob of this width, height (px) and area (pixels) can be a lamp.  可能是灯吗"""
    return area > LEAST_AREA and ROUND[0] < width / height < ROUND[1]


def lit_lamp(picture):
    """The largest lit lamp in a BGR image: red, yellow, green, or None.  最大的灯"""
    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV)
    found = {}
    for colour, (low, high) in HUES.items():
        mask = cv2.inRange(hsv, (low, *LEAST), (high, 255, 255))
        for _, _, width, height, area in cv2.connectedComponentsWithStats(mask)[2][1:]:
            if is_lamp(width, height, area):
                found[colour] = max(area, found.get(colour, 0))
    return max(found, key=found.get, default=None)


def main():
    rospy.init_node("round_lamp")
    bridge = cv_bridge.CvBridge()

    def image_callback(msg):
        lamp = lit_lamp(bridge.imgmsg_to_cv2(msg, "bgr8"))
        rospy.loginfo_throttle(1.0, "%s: %s", lamp,
                               "stand" if lamp in ("red", "yellow") else "drive")

    rospy.Subscriber("/camera/image", Image, image_callback, queue_size=1, buff_size=2**24)
    rospy.spin()


if __name__ == "__main__":
    main()

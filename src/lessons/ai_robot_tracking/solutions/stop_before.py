#!/usr/bin/env python3
"""Exercise stop_before: stop 1 m before the cylinder.  练习：停在圆柱前 1 米。"""

import time

import cv2
import cv_bridge
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

LEAST_RADIUS = 10  # px; smaller blobs are ignored  太小不算目标
TURN_GAIN = 0.005  # rad/s per px from the middle
SPEED, SEARCH_TURN = 0.2, 0.5  # m/s, rad/s
STOP_RADIUS = 165  # px: its apparent size from 1 m  从 1 米处看有这么大


def largest_red(picture):
    """Column and radius (px) of the circle round the largest red blob, or None.  最大的红色物体"""
    hsv = cv2.cvtColor(picture, cv2.COLOR_BGR2HSV)
    mask = cv2.inRange(hsv, (0, 100, 100), (10, 255, 255))
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    if not contours:
        return None
    (column, _), radius = cv2.minEnclosingCircle(max(contours, key=cv2.contourArea))
    return (column, radius) if radius > LEAST_RADIUS else None


def drive(picture):
    """Speed (m/s) and turn rate (rad/s, left positive) for a BGR image.  看到画面后怎么走"""
    seen = largest_red(picture)
    if seen is None:
        return 0.0, SEARCH_TURN
    column, radius = seen
    speed = SPEED if radius < STOP_RADIUS else 0.0
    return speed, -TURN_GAIN * (column - picture.shape[1] / 2)


class Tracker:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        self.publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.subscriber = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24)

    def image_callback(self, msg):
        command = Twist()
        command.linear.x, command.angular.z = drive(self.bridge.imgmsg_to_cv2(msg, "bgr8"))
        self.publisher.publish(command)

    def stop(self):
        self.subscriber.unregister()  # else the next image would start the car again
        self.publisher.publish(Twist())
        time.sleep(0.2)  # s: sending takes time


def main():
    rospy.init_node("stop_before")
    rospy.on_shutdown(Tracker().stop)
    rospy.spin()


if __name__ == "__main__":
    main()

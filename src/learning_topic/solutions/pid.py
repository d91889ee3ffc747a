#!/usr/bin/env python3
"""Exercise pid: the robot pulls to the left.  练习：机器人总是向左偏。"""

import time

import cv2
import cv_bridge
import numpy
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

LOWER_YELLOW = numpy.array([20, 43, 46])  # hue, saturation, value  色调、饱和度、亮度
UPPER_YELLOW = numpy.array([90, 255, 255])
WIDTH = 1920  # px; offsets are scaled to this width  按此宽度换算
SPEED = 0.3  # m/s
KP = 0.0025  # rad/s per px  比例
KI = 0.002  # rad/s per px·s  积分
KD = 0.001  # rad/s per px/s  微分


def line_offset(image):
    """How far right of the middle the line is in the near rows, px of WIDTH; None: no line."""
    top = 5 * image.shape[0] // 6
    band = image[top : top + image.shape[0] // 54]  # 20 rows of 1080
    hsv = cv2.cvtColor(band, cv2.COLOR_BGR2HSV)
    moments = cv2.moments(cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW), binaryImage=True)
    if moments["m00"] == 0:
        return None
    return (moments["m10"] / moments["m00"] / image.shape[1] - 0.5) * WIDTH


class Driver:
    """No ROS in here: check_exercise calls it, and so does the node below.  不依赖 ROS"""

    def __init__(self):
        self.total = 0.0  # px·s, the sum of all offsets times dt  误差的累积
        self.last = None  # offset in px and time in s of the last image  上一帧

    def steer(self, offset_px, time):
        """Turn rate in rad/s for a line this far right of the middle.  线在右边就向右转。"""
        change = 0.0  # px/s
        if self.last and time > self.last[1]:
            dt = time - self.last[1]
            change = (offset_px - self.last[0]) / dt
            self.total += offset_px * dt
        self.last = offset_px, time
        return -(KP * offset_px + KI * self.total + KD * change)

    def drive(self, image, time):
        """Speed (m/s) and turn rate (rad/s, left positive) for a BGR image at this time (s)."""
        offset_px = line_offset(image)
        if offset_px is None:
            return 0.0, 0.0  # line lost: stand still  线丢了，停车
        return SPEED, self.steer(offset_px, time)


class Follower:
    def __init__(self):
        self.bridge, self.driver = cv_bridge.CvBridge(), Driver()
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image, command = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8"), Twist()
        command.linear.x, command.angular.z = self.driver.drive(image, msg.header.stamp.to_sec())
        self.cmd_vel_pub.publish(command)

    def stop(self):
        """Stop before exiting: the robot keeps following the last command.  退出前停车。"""
        self.image_sub.unregister()  # else the next image would start the robot again
        for _ in range(3):
            self.cmd_vel_pub.publish(Twist())
            time.sleep(0.1)  # s


def main():
    rospy.init_node("follower", anonymous=True)
    rospy.on_shutdown(Follower().stop)
    rospy.spin()


if __name__ == "__main__":
    main()

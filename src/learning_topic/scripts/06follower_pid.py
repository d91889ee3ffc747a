#!/usr/bin/env python3
"""Lesson 6: steer with PID instead of P.  第六课：用 PID 代替 P。"""

import sys
import time

import cv2
import cv_bridge
import numpy
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
LOWER_YELLOW = numpy.array([20, 43, 46])
UPPER_YELLOW = numpy.array([90, 255, 255])
BAND_PX = 20  # number of rows searched  只看这么多行
SPEED = 0.2  # m/s
KP = 0.0025  # rad/s per px  比例
KI = 0.0005  # rad/s per px·s  积分
KD = 0.0005  # rad/s per px/s  微分
WIDTH = 1920  # px; offsets are scaled to this width, so the gains fit every camera  按此宽度换算


def yellow_mask(image):
    """255 where the BGR image is yellow, 0 elsewhere.  黄色处为 255，其余为 0。"""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    return cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW)


def band_rows(height):
    """The rows that are searched.  要看的那几行。"""
    top = 5 * height // 6
    return slice(top, top + BAND_PX)


def find_line(image):
    """Column and row of the middle of the yellow line, or None.  黄线的中心。"""
    rows = band_rows(image.shape[0])
    moments = cv2.moments(yellow_mask(image[rows]), binaryImage=True)
    if moments["m00"] == 0:
        return None
    column, row = moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]
    return int(column), rows.start + int(row)


def number(name, default):
    """This node's parameter; ends if it is no number.  读取参数，不是数字就退出。"""
    value = rospy.get_param("~" + name, default)
    if type(value) not in (int, float):
        sys.exit(f"06follower_pid.py: ~{name} must be a number, not {value!r}")
    return value


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        self.speed = number("speed", SPEED)
        self.kp = number("kp", KP)
        self.ki = number("ki", KI)
        self.kd = number("kd", KD)
        self.reset()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def reset(self):
        """Reset sum and last error.  清零。"""
        self.total = 0.0  # px·s
        self.last = None  # offset in px and time in s of the last image  上一帧

    def steer(self, offset_px, stamp):
        """Turn rate in rad/s for a line this far right of the middle; `stamp`: time in s."""
        change = 0.0  # px/s
        if self.last and stamp > self.last[1]:
            past = stamp - self.last[1]
            change = (offset_px - self.last[0]) / past
            self.total += offset_px * past
        self.last = offset_px, stamp
        return -(self.kp * offset_px + self.ki * self.total + self.kd * change)

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        centre = find_line(image)
        command = Twist()  # all zero: stand still  全为零：停车
        if centre is None:
            rospy.logwarn_throttle(2, "line lost, standing still  线丢了，停车")
            self.reset()
        else:
            cv2.circle(image, centre, 20, (0, 0, 255), -1)
            offset_px = (centre[0] - image.shape[1] / 2) * WIDTH / image.shape[1]
            command.linear.x = self.speed
            command.angular.z = self.steer(offset_px, msg.header.stamp.to_sec())
        self.cmd_vel_pub.publish(command)
        cv2.imshow("showImage", image)
        cv2.waitKey(3)  # ms

    def stop(self):
        """Stop before exiting: the robot keeps following the last command.  退出前停车。"""
        self.image_sub.unregister()  # else the next image would start the robot again
        for _ in range(3):  # sending takes time, and a callback may still be running
            self.cmd_vel_pub.publish(Twist())
            time.sleep(0.1)  # s of wall time: simulated time may be paused  用真实时间


def main():
    rospy.init_node("follower", anonymous=True)
    follower = Follower()
    rospy.on_shutdown(follower.stop)  # Ctrl-C
    rospy.spin()


if __name__ == "__main__":
    main()

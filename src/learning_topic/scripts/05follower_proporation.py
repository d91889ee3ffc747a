#!/usr/bin/env python3
"""Lesson 5: steer towards the line.  第五课：朝着线转向（比例控制）。"""

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
SPEED = 0.15  # m/s
STEER_GAIN = 1 / 1000  # rad/s per px


def yellow_mask(image):
    """255 where the BGR image is yellow, 0 elsewhere.  黄色处为 255，其余为 0。"""
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    return cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW)


def band_rows(height):
    """The rows that are searched.  要看的那几行。"""
    top = 5 * height // 6  # nearer than in lesson 4: the robot acts on it  比第四课更近
    return slice(top, top + BAND_PX)


def find_line(image):
    """Column and row of the middle of the yellow line, or None.  黄线的中心。"""
    rows = band_rows(image.shape[0])
    moments = cv2.moments(yellow_mask(image[rows]), binaryImage=True)
    if moments["m00"] == 0:
        return None
    column, row = moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]
    return int(column), rows.start + int(row)


def steer(offset_px):
    """Turn rate in rad/s for a line this far right of the middle.  线在右边就向右转。"""
    return -offset_px * STEER_GAIN


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        centre = find_line(image)
        command = Twist()  # all zero: stand still  全为零：停车
        if centre is None:
            rospy.logwarn_throttle(2, "line lost, standing still  线丢了，停车")
        else:
            cv2.circle(image, centre, 20, (0, 0, 255), -1)
            command.linear.x = SPEED
            command.angular.z = steer(centre[0] - image.shape[1] / 2)
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

#!/usr/bin/env python3
"""Lesson 7: steer by metres on the ground, not by pixels.  第七课：按地面上的米来转向。"""

import math
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
NEAR_ROW, FAR_ROW = 0.965, 0.90  # share of the image's height, 1 at the bottom  占图像高度
SPEED = 0.2  # m/s
SEARCH_TURN = 0.5  # rad/s, while the line is lost
MAX_TURN = 1.5  # rad/s
IMAGE_TIMEOUT = 0.5  # s without an image, then stand still  超时停车
GAIN = 4.0  # gain on the difference of the two arcs  两段圆弧不同时的增益
# The waffle's camera: m ahead of, left of and above base_footprint; rad, horizontal field of view.
CAMERA = {"forward": 0.069, "left": -0.047, "height": 0.117, "hfov": 1.3439}


def find_line(image, row):
    """Column of the yellow line in the band that starts at this row, or None.  黄线所在列。"""
    hsv = cv2.cvtColor(image[row : row + BAND_PX], cv2.COLOR_BGR2HSV)
    moments = cv2.moments(cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW), binaryImage=True)
    return moments["m10"] / moments["m00"] if moments["m00"] else None


def to_ground(column, row, image_shape, camera):
    """The ground point of a pixel: x forward, y left of base_footprint, in m.  像素到地面。"""
    height_px, width_px = image_shape[:2]
    focal_px = width_px / 2 / math.tan(camera["hfov"] / 2)
    distance = camera["height"] * focal_px / (row - height_px / 2)
    left = (width_px / 2 - column) * distance / focal_px
    return camera["forward"] + distance, camera["left"] + left


def see_line(image, camera):
    """Ground points (x, y) of the line in the near and far row; also marks them in the image."""
    points = []
    for part in (NEAR_ROW, FAR_ROW):
        row = int(part * image.shape[0])
        column = find_line(image, row)
        if column is not None:
            points.append(to_ground(column, row + BAND_PX / 2, image.shape, camera))
            cv2.circle(image, (int(column), row), 20, (0, 0, 255), -1)  # a red dot  红点
    return points


def bend_to(x, y):
    """Curvature in 1/m, left positive, of the arc from the base to this ground point.  曲率。"""
    return 2 * y / (x * x + y * y)


def steer(points, speed):
    """Turn rate in rad/s. On the line, one arc passes through both points, even in a bend.

    车在线上时，同一段圆弧通过远近两点，弯道里也一样。
    """
    near, far = bend_to(*points[0]), bend_to(*points[-1])
    return max(-MAX_TURN, min(MAX_TURN, speed * (near + GAIN * (near - far))))


def number(name, default):
    """This node's parameter; ends if it is no number.  读取参数，不是数字就退出。"""
    value = rospy.get_param("~" + name, default)
    if type(value) not in (int, float):
        sys.exit(f"07follower_ground.py: ~{name} must be a number, not {value!r}")
    return value


class Follower:
    def __init__(self):
        self.bridge = cv_bridge.CvBridge()
        self.speed = number("speed", SPEED)
        self.camera = CAMERA | rospy.get_param("~camera", {})
        self.side = 1.0  # +1: the line was last seen on the left, -1: on the right
        self.arrival = rospy.get_time()  # of the last image  上一帧图像的时刻
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        self.arrival = rospy.get_time()
        self.cmd_vel_pub.publish(self.command(see_line(image, self.camera)))
        cv2.imshow("showImage", image)
        cv2.waitKey(3)  # ms

    def command(self, points):
        """The command when the line is seen at these points.  看到这些点时怎么走。"""
        command = Twist()
        if points:
            self.side = math.copysign(1.0, points[0][1])
            command.linear.x = self.speed
            command.angular.z = steer(points, self.speed)
        else:
            rospy.logwarn_throttle(2, "line lost, turning to where it was  线丢了，转身去找")
            command.angular.z = self.side * SEARCH_TURN
        return command

    def check_images(self, _event):
        """Stand still when images stop coming.  图像中断时停车。"""
        if rospy.get_time() - self.arrival > IMAGE_TIMEOUT:
            rospy.logwarn_throttle(2, "no images, standing still  没有图像，停车")
            self.cmd_vel_pub.publish(Twist())

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
    rospy.Timer(rospy.Duration(0.1), follower.check_images, reset=True)
    rospy.spin()


if __name__ == "__main__":
    main()

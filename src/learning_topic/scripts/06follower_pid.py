#!/usr/bin/env python3
"""Lesson 6: steer with PID on the ground, not on the picture.  第六课：在地面坐标里做 PID。"""

import math
import os
import sys
import time

import cv2
import cv_bridge
import numpy
import rospy
import yaml
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

# Hue 0..180, saturation 0..255, value 0..255.  色调、饱和度、亮度。
LOWER_YELLOW = numpy.array([20, 43, 46])
UPPER_YELLOW = numpy.array([90, 255, 255])
BAND_PX = 20  # rows that are looked at  每条横带的行数
CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../config/follower.yaml")
KEYS = "cruise_speed max_turn search_turn image_timeout near_row far_row kp ki kd".split()
KEYS += "camera_forward camera_left camera_height camera_hfov".split()


def load_config(path, given):
    """The numbers of the YAML file at path; those in given (ROS parameters) win."""
    try:
        with open(path, encoding="utf-8") as file:
            config = dict(yaml.safe_load(file))
    except (TypeError, ValueError, yaml.YAMLError) as error:
        raise ValueError(f"{path}: not a table of 'key: number' lines") from error
    for place, values in ((path, config), ("the node's parameters", given)):
        for key, value in values.items():
            if key not in KEYS:
                raise ValueError(f"{place}: unknown key '{key}'; known: {', '.join(KEYS)}")
            if not isinstance(value, (int, float)):
                raise ValueError(f"{place}: '{key}' must be a number, not {value!r}")
    for key in set(KEYS) - set(config):
        raise ValueError(f"{path}: missing key '{key}'")
    return {**config, **given}


def find_line(image, row):
    """Column of the yellow line in the band that starts at this row, or None."""
    hsv = cv2.cvtColor(image[row : row + BAND_PX], cv2.COLOR_BGR2HSV)
    moments = cv2.moments(cv2.inRange(hsv, LOWER_YELLOW, UPPER_YELLOW), binaryImage=True)
    return moments["m10"] / moments["m00"] if moments["m00"] else None


def to_ground(column, row, image_shape, config):
    """Where on the floor a pixel lies: x forward, y left of base_footprint, in m."""
    height_px, width_px = image_shape[:2]
    focal_px = width_px / 2 / math.tan(config["camera_hfov"] / 2)
    distance = config["camera_height"] * focal_px / (row - height_px / 2)
    left = (width_px / 2 - column) * distance / focal_px
    return config["camera_forward"] + distance, config["camera_left"] + left


def see_line(image, config):
    """Floor points (x, y) of the line in the near and the far row, marked in the image."""
    points = []
    for key in ("near_row", "far_row"):
        row = int(config[key] * image.shape[0])
        column = find_line(image, row)
        if column is not None:
            points.append(to_ground(column, row + BAND_PX / 2, image.shape, config))
            cv2.circle(image, (int(column), row), 20, (0, 0, 255), -1)  # a red dot  红点
    return points


def bend_to(x, y):
    """Curvature in 1/m, left positive, of the arc from the base to this floor point."""
    return 2 * y / (x * x + y * y)


class Follower:
    def __init__(self, config):
        self.config = config
        self.bridge = cv_bridge.CvBridge()
        self.side = 1.0  # +1: the line was last seen on the left, -1: on the right
        self.stamp = self.arrival = rospy.get_time()  # of the last image  上一帧图像
        self.stand()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        self.arrival = rospy.get_time()
        self.follow(see_line(image, self.config), msg.header.stamp.to_sec())
        self.cmd_vel_pub.publish(self.command)
        cv2.imshow("showImage", image)
        cv2.waitKey(3)  # ms

    def follow(self, points, stamp):
        """Choose speed and turn from the points of the line seen at this time."""
        way, self.stamp = max(0, self.command.linear.x * (stamp - self.stamp)), stamp  # m
        if not points:
            rospy.logwarn_throttle(2, "line lost, turning to where it was  线丢了，转身去找")
            self.stand(turn=self.side * self.config["search_turn"])
            return
        self.side = math.copysign(1.0, points[0][1])
        near, far = bend_to(*points[0]), bend_to(*points[-1])
        self.command.linear.x = self.config["cruise_speed"]
        self.command.angular.z = self.pid(near, near - far, way)

    def pid(self, near, error, way):
        """Turn rate in rad/s: the bend to the near point, and PID on the error, both in 1/m.

        On the line one arc leads through both points: the error is 0, in a bend too.
        车在线上时，同一段圆弧通过远近两点，误差为零，弯道里也一样。
        """
        config, change = self.config, (error - self.error) / way if way else 0.0
        self.error, self.total = error, self.total + error * way
        pid = config["kp"] * error + config["ki"] * self.total + config["kd"] * change
        limit = config["max_turn"]
        return max(-limit, min(limit, config["cruise_speed"] * (near + pid)))

    def stand(self, turn=0.0):
        """Stand still, or turn on the spot, and forget the sum.  停车，积分清零。"""
        self.command = Twist()
        self.command.angular.z = turn
        self.error = self.total = 0.0  # 1/m, and that summed over the way driven

    def check_images(self, _event):
        """Stand still when images stop coming.  图像中断时停车。"""
        if rospy.get_time() - self.arrival > self.config["image_timeout"]:
            rospy.logwarn_throttle(2, "no images, standing still  没有图像，停车")
            self.stand()
            self.cmd_vel_pub.publish(self.command)

    def stop(self):
        """Stop before leaving: the last command stands until the next one.  退出前停车。"""
        self.image_sub.unregister()  # or the next image would start the robot again
        for _ in range(3):  # sending takes a moment, and an image may still be at work
            self.cmd_vel_pub.publish(Twist())
            time.sleep(0.1)  # s, on the wall: simulated time may stand still  用真实时间


def main():
    rospy.init_node("follower", anonymous=True)
    given = rospy.get_param("~", {})
    try:
        follower = Follower(load_config(given.pop("config", CONFIG), given))
    except (OSError, ValueError) as error:
        rospy.logfatal("%s", error)
        sys.exit(1)
    rospy.on_shutdown(follower.stop)
    rospy.Timer(rospy.Duration(0.1), follower.check_images, reset=True)
    rospy.spin()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Lesson 6: steer with PID on the ground, not on the picture.  第六课：在地面坐标里做 PID。"""

import math
import os
import sys

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
REACH = 0.15  # m; the trail counts this far around the base  只看底盘附近这么远的线
BEHIND = 0.3  # m; the trail is forgotten this far behind the base  身后更远的就忘掉
CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../config/follower.yaml")
KEYS = (
    "cruise_speed max_turn search_turn image_timeout near_row far_row kp ki kd "
    "camera_forward camera_left camera_height camera_hfov"
).split()


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
    for fraction in (config["near_row"], config["far_row"]):
        row = int(fraction * image.shape[0])
        column = find_line(image, row)
        if column is not None:
            points.append(to_ground(column, row + BAND_PX / 2, image.shape, config))
            cv2.circle(image, (int(column), row), 20, (0, 0, 255), -1)  # a red dot  红点
    return numpy.reshape(points, (-1, 2))


def moved(trail, forward, turn):
    """The same floor points, seen after driving forward (m) and turning left (rad)."""
    c, s = math.cos(turn), math.sin(turn)
    trail = (trail - (forward, 0)) @ numpy.array([[c, -s], [s, c]])
    return trail[trail[:, 0] > -BEHIND]


def fit_line(trail):
    """The line at the base: offset (m, left), slope and bend (1/m), from floor points."""
    x, y = trail.T
    weight = numpy.exp(-((x / REACH) ** 2) / 2) + 1e-3
    powers = numpy.stack([numpy.ones_like(x), x, x * x / 2], axis=1) * weight[:, None]
    # One more equation, bend = 0, with little weight: two points alone make a straight line.
    # 再加一个权重很小的方程“曲率为零”：只有两个点时就当作直线。
    powers = numpy.vstack([powers, (0, 0, 1e-3)])
    return numpy.linalg.lstsq(powers, numpy.append(y * weight, 0), rcond=None)[0]


def steer(line, integral, config):
    """Turn rate in rad/s: PID on the offset, plus what the bend itself asks for."""
    offset, slope, bend = line  # slope is how fast the offset grows: the D of PID
    curvature = config["kp"] * offset + config["ki"] * integral + config["kd"] * slope + bend
    turn, limit = config["cruise_speed"] * curvature, config["max_turn"]
    return max(-limit, min(limit, turn))


class Follower:
    def __init__(self, config):
        self.config = config
        self.bridge = cv_bridge.CvBridge()
        self.trail = numpy.empty((0, 2))  # floor points of the line, in base_footprint
        self.integral = 0.0  # m²: offset summed over the way driven
        self.speed = self.turn = 0.0  # the last command
        self.side = 1.0  # +1: the line was last seen on the left, -1: on the right
        self.stamp = self.arrival = rospy.get_time()
        cv2.namedWindow("showImage", cv2.WINDOW_NORMAL)
        self.cmd_vel_pub = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.image_sub = rospy.Subscriber(
            "camera/rgb/image_raw", Image, self.image_callback, queue_size=1, buff_size=2**24
        )

    def image_callback(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, desired_encoding="bgr8")
        self.arrival = rospy.get_time()
        self.follow(see_line(image, self.config), msg.header.stamp.to_sec())
        self.drive()
        cv2.imshow("showImage", image)
        cv2.waitKey(3)  # ms

    def follow(self, seen, stamp):
        """Choose speed and turn from the points seen at this time."""
        dt, self.stamp = stamp - self.stamp, stamp
        if not 0 <= dt < self.config["image_timeout"]:  # after a gap or a reset nothing holds
            dt, self.trail, self.integral = 0.0, numpy.empty((0, 2)), 0.0
        self.trail = moved(self.trail, self.speed * dt, self.turn * dt)
        if len(seen) == 0:
            rospy.logwarn_throttle(2, "line lost, turning to where it was  线丢了，转身去找")
            self.speed, self.turn = 0.0, self.side * self.config["search_turn"]
            self.integral = 0.0
            return
        self.side = math.copysign(1.0, seen[0][1])
        self.trail = numpy.vstack([self.trail, seen])
        line = fit_line(self.trail)
        self.integral += line[0] * self.speed * dt
        self.speed, self.turn = self.config["cruise_speed"], steer(line, self.integral, self.config)

    def drive(self):
        command = Twist()
        command.linear.x, command.angular.z = self.speed, self.turn
        if not rospy.is_shutdown():
            self.cmd_vel_pub.publish(command)

    def check_images(self, _event):
        """Stand still when images stop coming.  图像中断时停车。"""
        if rospy.get_time() - self.arrival > self.config["image_timeout"]:
            rospy.logwarn_throttle(2, "no images, standing still  没有图像，停车")
            self.speed = self.turn = 0.0
            self.drive()


def main():
    rospy.init_node("follower", anonymous=True)
    given = rospy.get_param("~", {})
    try:
        follower = Follower(load_config(given.pop("config", CONFIG), given))
    except (OSError, ValueError) as error:
        rospy.logfatal("%s", error)
        sys.exit(1)
    rospy.on_shutdown(lambda: follower.cmd_vel_pub.publish(Twist()))
    rospy.Timer(rospy.Duration(0.1), follower.check_images, reset=True)
    rospy.spin()


if __name__ == "__main__":
    main()

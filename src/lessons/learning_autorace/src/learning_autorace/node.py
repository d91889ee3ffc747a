"""Shared by all lessons: the robot's sensor data, and a command for each image."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import cv_bridge
import numpy as np
import rospkg
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, LaserScan

from learning_autorace.calibration import (
    Calibration,
    CalibrationError,
    compensate,
    floor_maps,
    load_calibration,
)

LASER_FORWARD = -0.032  # m, from base_footprint


@dataclass
class Seen:
    """The robot's sensor data at an image's arrival."""

    time: float  # s
    image: np.ndarray  # (h, w, 3) BGR
    view: np.ndarray  # the ground from above, BGR, compensated
    # (N, 2) m, the laser's hits: x ahead and y left of the base
    points: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)  # odometry: x, y in m, yaw in rad


def laser_points(scan: LaserScan) -> np.ndarray:
    """(N, 2) m, x ahead and y left of base_footprint: the laser's hits."""
    ranges = np.array(scan.ranges)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    met = (ranges >= scan.range_min) & (ranges < scan.range_max)
    ranges, angles = ranges[met], angles[met]
    return np.stack((LASER_FORWARD + ranges * np.cos(angles), ranges * np.sin(angles)), 1)


class Node:
    """Calls `drive` for each image; it returns speed in m/s and turn rate in rad/s."""

    def __init__(self, calibration: Calibration, drive: Callable[[Seen], tuple[float, float]]):
        self._calibration, self._drive = calibration, drive
        self._maps: tuple[np.ndarray, np.ndarray] | None = None
        self._seen = Seen(0.0, np.empty(0), np.empty(0))
        self._bridge = cv_bridge.CvBridge()
        self._commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("scan", LaserScan, self._take_scan, queue_size=1)
        rospy.Subscriber("odom", Odometry, self._take_odometry, queue_size=1)
        self._images = rospy.Subscriber("camera/image", Image, self._take_image, queue_size=1,
                                        buff_size=2**24)

    def _take_scan(self, message: LaserScan) -> None:
        self._seen.points = laser_points(message)

    def _take_odometry(self, message: Odometry) -> None:
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        self._seen.pose = place.x, place.y, 2 * math.atan2(turn.z, turn.w)

    def _take_image(self, message: Image) -> None:
        try:
            image = self._bridge.imgmsg_to_cv2(message, desired_encoding="bgr8")
        except (TypeError, ValueError) as error:  # CvBridgeError; too few bytes, huge sizes
            rospy.logwarn_throttle(5.0, f"an image that cannot be used: {error}")
            return
        if self._maps is None:
            self._maps = floor_maps(image.shape[1], image.shape[0], self._calibration)
        self._seen.time, self._seen.image = message.header.stamp.to_sec(), image
        self._seen.view = compensate(cv2.remap(image, *self._maps, cv2.INTER_LINEAR),
                                     self._calibration.clip_percent)
        command = Twist()
        command.linear.x, command.angular.z = self._drive(self._seen)
        self._commands.publish(command)

    def stop(self) -> None:
        """Stop before exiting: the robot keeps following the last command."""
        self._images.unregister()
        for _ in range(3):
            self._commands.publish(Twist())
            time.sleep(0.1)  # s of wall time: simulated time may be paused


def calibration_of_parameter() -> Calibration:
    """From the file in ~calibration, or config/camera.yaml; an error in it ends the program."""
    usual = Path(rospkg.RosPack().get_path("learning_autorace")) / "config" / "camera.yaml"
    try:
        return load_calibration(Path(rospy.get_param("~calibration", str(usual))))
    except CalibrationError as error:
        sys.exit(f"{rospy.get_name()}: {error}")


def run(name: str, make: Callable[[Calibration], Callable[[Seen], tuple[float, float]]]) -> None:
    """Run a node until Ctrl-C that drives with the function that `make` returns."""
    rospy.init_node(name)
    calibration = calibration_of_parameter()
    node = Node(calibration, make(calibration))
    rospy.on_shutdown(node.stop)
    rospy.spin()

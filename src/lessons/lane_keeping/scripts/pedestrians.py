#!/usr/bin/env python3
"""Walks the people over the zebra crossings: a command to each of them with each picture.

Where a crossing is and how it is used stands in config/crossings.yaml. People look before they
step out, and do not step out close before a car that drives.
按 config/crossings.yaml 让行人过斑马线；行人会先看车，车近时不上路
"""

import math
import sys
import threading
from pathlib import Path

if __name__ == "__main__":
    sys.path.pop(0)  # this folder: there lane_keeping.py would be imported in the package's place

import numpy as np
import rospkg
import rospy
import yaml
from geometry_msgs.msg import Twist
from lane_keeping.walking import Crossing, Habits, Walker
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo

LATEST = 0.022  # s: places come at 50 Hz; an older one is not the last before a picture
PATIENCE = 0.1  # s, wall, to wait for it
KEYS = {"length", "half_width", "kerb", "far", "zebras"}


class Place:
    """The last odometry of one model: where it is, and how fast; may be waited for."""

    def __init__(self, topic):
        self._news = threading.Condition()
        self._message = None
        rospy.Subscriber(topic, Odometry, self._take, queue_size=1, tcp_nodelay=True)

    def at(self, time):
        """x, y, speed as they were at a simulated time (s), or the newest there is; or None."""
        with self._news:
            self._news.wait_for(lambda: self._time() > time - LATEST, PATIENCE)
            if self._message is None:
                return None
            pose, twist = self._message.pose.pose.position, self._message.twist.twist.linear
            return pose.x, pose.y, math.hypot(twist.x, twist.y)

    def _time(self):
        return -math.inf if self._message is None else self._message.header.stamp.to_sec()

    def _take(self, message):
        with self._news:
            self._message = message
            self._news.notify_all()


class Pedestrians:
    """All who walk."""

    def __init__(self, crossings, habits, seed):
        self._car = Place("ground_truth")
        self._people = []
        for number, crossing in enumerate(crossings, start=1):
            walker = Walker(crossing, habits, np.random.default_rng([seed, number]))
            command = rospy.Publisher(f"pedestrian_{number}/cmd_vel", Twist, queue_size=1)
            self._people.append((walker, Place(f"pedestrian_{number}/odom"), command))
        rospy.Subscriber("camera_info", CameraInfo, self._walk, queue_size=1, tcp_nodelay=True)

    def _walk(self, info):
        now = info.header.stamp.to_sec()
        car = self._car.at(now)
        for walker, where, command in self._people:
            place, twist = where.at(now), Twist()
            if place is not None:
                twist.linear.x = walker.step(now, place[:2], car)  # each looks to the lane's left
            command.publish(twist)


def read_crossings(path):
    """The crossings of a YAML file; exits with one line if it is none."""
    try:
        values = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        unknown = sorted(set(values) ^ KEYS)
        if unknown:
            raise ValueError(f"key {unknown[0]!r} is missing or unknown")
        common = (values["length"], values["kerb"], values["far"])
        return [Crossing(zebra["x"], zebra["y"], zebra["heading"], *common)
                for zebra in values["zebras"]]
    except (OSError, ValueError, KeyError, TypeError, yaml.YAMLError) as error:
        raise SystemExit(f"pedestrians: {path}: {' '.join(str(error).split())}") from error


def main():
    rospy.init_node("pedestrians")
    package = Path(rospkg.RosPack().get_path("lane_keeping"))
    path = rospy.get_param("~crossings", str(package / "config" / "crossings.yaml"))
    habits = Habits(near=float(rospy.get_param("~near", 0.0)))
    Pedestrians(read_crossings(path), habits, int(rospy.get_param("~seed", 0)))
    rospy.spin()


if __name__ == "__main__":
    main()

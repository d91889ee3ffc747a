#!/usr/bin/env python3
"""Moves people over the zebra crossings: sends each a command with every camera image.

config/crossings.yaml describes the crossings. People look before they step out, and do not step
out close in front of a moving car.
按 config/crossings.yaml 让行人过斑马线；行人会先看车，车近时不上路
"""

import math
import reprlib
import sys
import threading
from pathlib import Path

import numpy as np
import rospkg
import rospy
import yaml
from geometry_msgs.msg import Twist
from lane_keeping.walking import Crossing, Habits, Walker
from nav_msgs.msg import Odometry
from rospy.client import load_command_line_node_params
from sensor_msgs.msg import CameraInfo

LATEST = 0.022  # s: odometry comes at 50 Hz, so one older than this is not the last before an image
PATIENCE = 0.1  # s, wall, to wait for it
MEASURES, PLACE = ("length", "half_width", "kerb", "far"), ("x", "y", "heading")
PARAMETERS = ("crossings", "near", "seed")
MOST = 1e6  # largest absolute value of any number


class Place:
    """The last odometry of one model, position and speed; can wait for a given time."""

    def __init__(self, topic):
        self._news = threading.Condition()
        self._message = None
        rospy.Subscriber(topic, Odometry, self._take, queue_size=1, tcp_nodelay=True)

    def at(self, time):
        """x, y, speed at a simulated time (s), else the newest; None if there are none."""
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
    """All pedestrians."""

    def __init__(self, crossings, habits, seed):
        self._car, self._people = Place("ground_truth"), []
        # First: a program that waits for our publishers before starting time also waits for this.
        rospy.Subscriber("camera_info", CameraInfo, self._walk, queue_size=1, tcp_nodelay=True)
        for number, crossing in enumerate(crossings, start=1):
            walker = Walker(crossing, habits, np.random.default_rng([seed, number]))
            command = rospy.Publisher(f"pedestrian_{number}/cmd_vel", Twist, queue_size=1)
            self._people.append((walker, Place(f"pedestrian_{number}/odom"), command))

    def _walk(self, info):
        now = info.header.stamp.to_sec()
        car = self._car.at(now)
        for walker, where, command in self._people:
            place, twist = where.at(now), Twist()
            if place is not None:
                twist.linear.x = walker.step(now, place[:2], car)  # each faces the lane's left
            command.publish(twist)


def read_crossings(path):
    """The crossings of a YAML file; exits with one line if the file is invalid."""
    try:
        values = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        zebras = values.pop("zebras", ()) if isinstance(values, dict) else ()
        length, _, kerb, far = numbers(values, MEASURES, "")
        return [Crossing(*numbers(zebra, PLACE, f"zebra {count}: "), length, kerb, far)
                for count, zebra in enumerate(zebras, start=1)]
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise SystemExit(f"pedestrians: {path}: {' '.join(str(error).split())}") from error


def numbers(table, keys, where):
    """The values of these keys as floats; ValueError if keys differ or one is not a number."""
    wrong = sorted(set(table if isinstance(table, dict) else ()) ^ set(keys), key=str)
    if wrong:
        raise ValueError(f"{where}key {wrong[0]!r:.80} is missing or unknown")
    for key in keys:
        value = table[key]
        if type(value) not in (int, float) or not -MOST < value < MOST:
            raise ValueError(f"{where}'{key}' must be a number, not {reprlib.repr(value)[:80]}")
    return [float(table[key]) for key in keys]


def read_parameters(given):
    """The crossings' file, `near` (m) and the seed; exits with one line if one is invalid."""
    for key in given:
        if key not in PARAMETERS:
            raise SystemExit(f"pedestrians: unknown parameter ~{key}; known: "
                             f"{', '.join(PARAMETERS)}")
    near, seed = given.get("near", 0.0), given.get("seed", 0)
    if type(near) not in (int, float) or not 0 <= near < MOST:
        raise SystemExit(f"pedestrians: ~near must be a number from 0 on, m, not {near!r}")
    if type(seed) is not int or seed < 0:
        raise SystemExit(f"pedestrians: ~seed must be a whole number from 0 on, not {seed!r}")
    package = Path(rospkg.RosPack().get_path("lane_keeping"))
    path = str(given.get("crossings") or package / "config" / "crossings.yaml")
    return path, float(near), seed


def main():
    rospy.init_node("pedestrians")
    given = rospy.get_param("~", {})
    for key in load_command_line_node_params(sys.argv):
        rospy.delete_param(f"~{key}")  # _key:=value must not affect the next run
    path, near, seed = read_parameters(given)
    Pedestrians(read_crossings(path), Habits(near=near), seed)
    rospy.spin()


if __name__ == "__main__":
    main()

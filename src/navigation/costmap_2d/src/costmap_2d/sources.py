"""Sensors of a costmap: from their topics to observations in the costmap's frame."""

from __future__ import annotations

import threading
from collections import deque
from typing import Any

import numpy as np
import rospy
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan, PointCloud, PointCloud2

from costmap_2d.clouds import (
    points_of_cloud,
    points_of_cloud2,
    points_of_scan,
    rotation_and_translation,
)
from nav_algorithms.costmap.obstacles import Observation
from nav_nodes.complaints import Complaints
from nav_nodes.silence import why_silent
from nav_nodes.transforms import Transforms

TYPES = {"LaserScan": numpy_msg(LaserScan), "PointCloud": PointCloud, "PointCloud2": PointCloud2}
WAITING = 10   # messages that wait for their transform; upstream's queue is 50
SILENCE = 5.0  # s of wall time until a line, where no expected_update_rate says otherwise


class Source:
    """One sensor. Messages come on ROS's thread, `collect` is called by the costmap's.

    A message waits until tf knows its frame at its stamp. With `observation_persistence` 0 the
    newest that could be placed counts until the next.
    """

    def __init__(self, settings: dict[str, Any], frame: str, transforms: Transforms,
                 complaints: Complaints) -> None:
        """`settings` by params/source.yaml; `frame` is the costmap's."""
        self.settings = settings
        self._frame, self._transforms, self._complaints = frame, transforms, complaints
        self._sensor_frame = settings["sensor_frame"].lstrip("/")
        self._what = f"{settings['data_type']} on {rospy.resolve_name(settings['topic'])}"
        self._lock = threading.Lock()
        self._waiting: deque = deque(maxlen=WAITING)
        self._heard = False
        self._seen: list[tuple[rospy.Time, Observation]] = []  # newest first
        self._updated = self._heard_at = rospy.Time.now()
        self._subscriber: rospy.Subscriber | None = None

    def start(self) -> None:
        """Begins to listen."""
        self._updated = self._heard_at = rospy.Time.now()
        if self._subscriber is None:
            self._subscriber = rospy.Subscriber(
                self.settings["topic"], TYPES[self.settings["data_type"]], self._take,
                queue_size=WAITING)

    def stop(self) -> None:
        """Listens no more."""
        if self._subscriber is not None:
            self._subscriber.unregister()
            self._subscriber = None

    def forget(self) -> None:
        """Time went backwards: what was seen is of another world."""
        with self._lock:
            self._waiting.clear()
        self._seen.clear()
        self._updated = self._heard_at = rospy.Time.now()

    def is_current(self) -> bool:
        """Whether an observation came within `expected_update_rate`; always if that is 0."""
        rate = self.settings["expected_update_rate"]
        return not rate or (rospy.Time.now() - self._updated).to_sec() <= rate

    def silence(self) -> tuple[str, float]:
        """("LaserScan on /scan", s of ROS time since a message came, or since `start`)."""
        return self._what, (rospy.Time.now() - self._heard_at).to_sec()

    def collect(self) -> list[Observation]:
        """What counts now."""
        with self._lock:
            waiting, silent = list(self._waiting), not self._heard
            self._heard = False
        if silent and self._subscriber is not None:
            self._complain(self._subscriber)
        keep = self.settings["observation_persistence"]
        if keep:
            self._place_all(waiting, keep)
        else:
            self._place_newest(waiting)
        return [observation for _, observation in self._seen]

    def _take(self, message: Any) -> None:
        with self._lock:
            self._waiting.append(message)
            self._heard = True
        self._heard_at = rospy.Time.now()
        self._complaints.present(self._what)

    def _complain(self, subscriber: rospy.Subscriber) -> None:
        rate = self.settings["expected_update_rate"]
        why = why_silent(subscriber, self.settings["topic"])
        self._complaints.missing(self._what, f"expected every {rate:g} s; {why}" if rate else why,
                                 patience=rate or SILENCE)

    def _place_newest(self, waiting: list) -> None:
        for n in range(len(waiting) - 1, -1, -1):
            observation = self._placed(waiting[n])
            if observation is not None:
                self._seen = [(waiting[n].header.stamp, observation)]
                self._updated = rospy.Time.now()
                self._drop(waiting[:n + 1])
                return

    def _place_all(self, waiting: list, keep: float) -> None:
        placed = [(message, self._placed(message)) for message in waiting]
        placed = [(message, observation) for message, observation in placed
                  if observation is not None]
        for message, observation in placed:
            self._seen.insert(0, (message.header.stamp, observation))
            self._updated = rospy.Time.now()
        self._drop([message for message, _ in placed])
        self._seen = [(stamp, observation) for stamp, observation in self._seen
                      if (self._updated - stamp).to_sec() <= keep]

    def _drop(self, messages: list) -> None:
        gone = {id(message) for message in messages}
        with self._lock:
            left = [message for message in self._waiting if id(message) not in gone]
            self._waiting.clear()
            self._waiting.extend(left)

    def _placed(self, message: Any) -> Observation | None:
        """The message in the costmap's frame; None while tf cannot say where that is."""
        stamp, frame = message.header.stamp, message.header.frame_id.lstrip("/")
        try:
            points, when = self._points(message)
        except ValueError as error:
            rospy.logwarn_throttle(5.0, "%s: %s", self._what, error)
            points, when = np.zeros((0, 3)), np.zeros(0)
        start = self._transform(frame, stamp)
        end = self._transform(frame, stamp + rospy.Duration(when[-1])) if when.any() else start
        sensor = self._transform(self._sensor_frame or frame, stamp)
        if start is None or end is None or sensor is None:
            return None
        origin, points = sensor[1], _moved(points, start, end, when)
        settings = self.settings
        high = (points[:, 2] >= settings["min_obstacle_height"]) \
            & (points[:, 2] <= settings["max_obstacle_height"])
        return Observation(origin, points[high], settings["obstacle_range"],
                           settings["raytrace_range"])

    def _points(self, message: Any) -> tuple[np.ndarray, np.ndarray]:
        """(points (N, 3) in the message's frame, (N,) s after its stamp)."""
        kind = self.settings["data_type"]
        if kind == "LaserScan":
            return points_of_scan(message, self.settings["inf_is_valid"])
        points = points_of_cloud(message) if kind == "PointCloud" else points_of_cloud2(message)
        return points, np.zeros(len(points))

    def _transform(self, frame: str, stamp: rospy.Time) -> tuple[np.ndarray, np.ndarray] | None:
        found = self._transforms.find(self._frame, frame, stamp)
        return None if found is None else rotation_and_translation(found)


def _moved(points: np.ndarray, start: tuple, end: tuple, when: np.ndarray) -> np.ndarray:
    """Points of a sensor that went from `start` to `end` evenly while it measured."""
    first = points @ start[0].T + start[1]
    if not when.any():
        return first
    return first + (when / when[-1])[:, None] * (points @ end[0].T + end[1] - first)

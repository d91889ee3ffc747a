"""Sensors of a costmap: convert their messages to observations in the costmap's frame."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import rospy
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan, PointCloud, PointCloud2

from costmap_2d.clouds import placed, rotation_and_translation, timed_points
from costmap_2d.settings import LayerSettings
from nav_algorithms.costmap.layer import Layer
from nav_algorithms.costmap.obstacles import Observation, ObstacleLayer
from nav_nodes.missing_data import MissingData, why_silent
from nav_nodes.transforms import Transforms, is_far

TYPES = {"LaserScan": numpy_msg(LaserScan), "PointCloud": PointCloud, "PointCloud2": PointCloud2}
WAITING = 50   # messages that may wait for their transform, as upstream's queue
SILENCE = 5.0  # s of wall time until silence is logged, unless expected_update_rate is set


@dataclass(frozen=True)
class MessageAge:
    """Ages are s of ROS time; negative: from before the clock was set back.

    `what`: "LaserScan on /scan"; `placed`: age of the newest message that tf can transform to the
    costmap's frame, whether or not an update has used it. `usable`: "LaserScan on /scan that can be
    placed"; `why` it is not; empty if it is, or if the line about tf says so.
    """

    what: str
    usable: str
    heard: float
    placed: float
    why: str = ""


class _Arrival(NamedTuple):
    message: Any
    at: rospy.Time  # time of arrival


class Source:
    """One sensor. Messages come on ROS's thread, `collect` is called on the costmap's.

    A message waits until tf can transform it at its stamp. With `observation_persistence` 0 the
    newest one that could be transformed counts until the next.
    """

    def __init__(self, settings: dict[str, Any], frame: str, transforms: Transforms,
                 missing_data: MissingData) -> None:
        """`settings`: parameters of params/source.yaml; `frame` is the costmap's."""
        self.settings = settings
        self._frame, self._transforms, self._missing_data = frame, transforms, missing_data
        self._sensor_frame = settings["sensor_frame"].lstrip("/")
        self._what = f"{settings['data_type']} on {rospy.resolve_name(settings['topic'])}"
        self._lock = threading.Lock()
        self._usable = f"{self._what} that can be placed"
        self._waiting: deque[_Arrival] = deque(maxlen=WAITING)
        self._heard = False
        self._newest: _Arrival | None = None  # of those that tf can transform
        self._fault = ""  # in the newest messages, while all of them are invalid
        self._complained = False
        self._seen: list[tuple[rospy.Time, Observation]] = []  # newest first
        self._updated = self._heard_at = self._placed_at = rospy.Time.now()
        self._subscriber: rospy.Subscriber | None = None

    def start(self) -> None:
        """Subscribes."""
        self._updated = self._heard_at = self._placed_at = rospy.Time.now()
        if self._subscriber is None:
            self._forget_messages()  # those from before a pause
            self._subscriber = rospy.Subscriber(
                self.settings["topic"], TYPES[self.settings["data_type"]], self._take,
                queue_size=WAITING)

    def stop(self) -> None:
        """Unsubscribes."""
        if self._subscriber is not None:
            self._subscriber.unregister()
            self._subscriber = None

    def forget(self) -> None:
        """Time went backwards: drop all observations."""
        self._forget_messages()
        self._seen.clear()
        self._updated = self._heard_at = self._placed_at = rospy.Time.now()

    def _forget_messages(self) -> None:
        with self._lock:
            self._waiting.clear()
            self._newest, self._fault = None, ""

    def is_current(self) -> bool:
        """Whether an observation came within `expected_update_rate`; always if that is 0."""
        rate = self.settings["expected_update_rate"]
        return not rate or (rospy.Time.now() - self._updated).to_sec() <= rate

    def ages(self) -> MessageAge:
        """Ages, since `start` if nothing came. On any thread, also between two updates."""
        with self._lock:
            waiting = list(self._waiting)
        for arrival in reversed(waiting):
            if arrival is self._newest or self._can_be_placed(arrival.message):
                self._newest, self._placed_at = arrival, arrival.at
                break
        all_is_well = waiting and waiting[-1] is self._newest and not self._fault
        now = rospy.Time.now()
        return MessageAge(self._what, self._usable, (now - self._heard_at).to_sec(),
                          (now - self._placed_at).to_sec(),
                          "" if all_is_well else self._why_useless(waiting))

    def collect(self) -> list[Observation]:
        """The observations that count now."""
        with self._lock:
            waiting, silent = list(self._waiting), not self._heard
            self._heard = False
        if silent and self._subscriber is not None:
            self._complain(self._subscriber)
        keep = self.settings["observation_persistence"]
        newest = self._place_all(waiting, keep) if keep else self._place_newest(waiting)
        if newest is not None:
            self._note(newest)
        elif not silent and (why := self._why_useless(waiting)):
            self._missing_data.missing(self._usable, why, patience=SILENCE)
            self._complained = True
        return [observation for _, observation in self._seen]

    def _take(self, message: Any) -> None:
        now, stamp = rospy.Time.now(), message.header.stamp
        near = not is_far(stamp)
        with self._lock:
            self._heard = True
            if near:
                self._waiting.append(_Arrival(message, now))
        if not near:
            self._pass_over(f"a message dated {stamp.secs} s has come at {now.to_sec():.0f} s")
        self._heard_at = now
        self._missing_data.present(self._what)

    def _pass_over(self, fault: str) -> None:
        if not self._fault:
            rospy.logwarn_throttle(5.0, "%s: %s", self._what, fault)
        self._fault = fault

    def _note(self, arrival: _Arrival) -> None:
        """Take note of the newest message that was transformed."""
        self._newest, self._placed_at, self._fault = arrival, arrival.at, ""
        if self._complained:
            self._missing_data.present(self._usable)
            self._complained = False

    def _why_useless(self, waiting: list[_Arrival]) -> str:
        """Why no message is usable; "" if tf is the reason, or none is waiting."""
        if self._fault or not waiting:
            return self._fault
        message = waiting[-1].message
        if not self._is_known(message.header.frame_id, message.header.stamp):
            return ""
        try:
            sweep = self._sweep(message)
        except ValueError as error:
            return str(error)
        return "" if not sweep else (
            f"its sweeps take {sweep:.1f} s (time_increment), and tf does not know the ends "
            "of them")

    def _complain(self, subscriber: rospy.Subscriber) -> None:
        rate = self.settings["expected_update_rate"]
        why = why_silent(subscriber, self.settings["topic"])
        self._missing_data.missing(self._what, f"expected every {rate:g} s; {why}" if rate else why,
                                   patience=rate or SILENCE)

    def _place_newest(self, waiting: list[_Arrival]) -> _Arrival | None:
        for n in range(len(waiting) - 1, -1, -1):
            observation = self._placed(waiting[n])
            if observation is not None:
                self._seen = [(waiting[n].message.header.stamp, observation)]
                self._updated = rospy.Time.now()
                self._drop(waiting[:n + 1])
                return waiting[n]
        return None

    def _place_all(self, waiting: list[_Arrival], keep: float) -> _Arrival | None:
        found = [(arrival, self._placed(arrival)) for arrival in waiting]
        found = [(arrival, observation) for arrival, observation in found
                 if observation is not None]
        for arrival, observation in found:
            self._seen.insert(0, (arrival.message.header.stamp, observation))
            self._updated = rospy.Time.now()
        self._drop([arrival for arrival, _ in found])
        self._seen = [(stamp, observation) for stamp, observation in self._seen
                      if (self._updated - stamp).to_sec() <= keep]
        return found[-1][0] if found else None

    def _drop(self, arrivals: list[_Arrival]) -> None:
        gone = {id(arrival) for arrival in arrivals}
        with self._lock:
            left = [arrival for arrival in self._waiting if id(arrival) not in gone]
            self._waiting.clear()
            self._waiting.extend(left)

    def _placed(self, arrival: _Arrival) -> Observation | None:
        """The message in the costmap's frame; None while tf lacks the transform.

        Always None for an invalid message, which says nothing about obstacles.
        """
        message = arrival.message
        stamp, frame = message.header.stamp, message.header.frame_id.lstrip("/")
        start = self._transform(frame, stamp)
        if start is None:
            return None
        try:
            points, when = self._points(message)
        except ValueError as error:
            self._pass_over(str(error))
            self._drop([arrival])
            return None
        end = self._transform(frame, stamp + rospy.Duration(when[-1])) if when.any() else start
        sensor = self._transform(self._sensor_frame or frame, stamp)
        if end is None or sensor is None:
            return None
        origin, points = sensor[1], placed(points, start, end, when)
        settings = self.settings
        high = (points[:, 2] >= settings["min_obstacle_height"]) \
            & (points[:, 2] <= settings["max_obstacle_height"])
        return Observation(origin, points[high], settings["obstacle_range"],
                           settings["raytrace_range"])

    def _can_be_placed(self, message: Any) -> bool:
        """Whether `_placed` would succeed, without logging; points of clouds are not checked."""
        stamp, frame = message.header.stamp, message.header.frame_id
        if not (self._is_known(frame, stamp)
                and self._is_known(self._sensor_frame or frame, stamp)):
            return False
        if self._fault and self.settings["data_type"] != "LaserScan":
            return False  # checking each would take too long
        try:
            sweep = self._sweep(message)
        except ValueError:
            return False
        return not sweep or self._is_known(frame, stamp + rospy.Duration(sweep))

    def _is_known(self, frame: str, stamp: rospy.Time) -> bool:
        frame = frame.lstrip("/")  # tf2 prints a warning of its own for an empty name
        return bool(frame) and self._transforms.buffer.can_transform(self._frame, frame, stamp)

    def _sweep(self, message: Any) -> float:
        """s from its stamp to its last valid beam; 0 for a cloud. Raises ValueError."""
        if self.settings["data_type"] != "LaserScan":
            return 0.0
        when = self._points(message)[1]
        return float(when[-1]) if len(when) else 0.0

    def _points(self, message: Any) -> tuple[np.ndarray, np.ndarray]:
        return timed_points(message, self.settings["data_type"], self.settings["inf_is_valid"])

    def _transform(self, frame: str, stamp: rospy.Time) -> tuple[np.ndarray, np.ndarray] | None:
        found = self._transforms.find(self._frame, frame, stamp)
        return None if found is None else rotation_and_translation(found)


class Sensors:
    """The sources of every layer; as for a Source, only the costmap's thread observes."""

    def __init__(self, layers: Sequence[LayerSettings], frame: str, transforms: Transforms,
                 missing_data: MissingData) -> None:
        """`frame` is the costmap's."""
        self._of_layers = {each.name: [Source(values, frame, transforms, missing_data)
                                       for values in each.sources.values()] for each in layers}
        self._all = [source for sources in self._of_layers.values() for source in sources]

    def start(self) -> None:
        """Subscribe all."""
        for source in self._all:
            source.start()

    def stop(self) -> None:
        """Unsubscribe all."""
        for source in self._all:
            source.stop()

    def forget(self) -> None:
        """Drop all data, after time went backwards."""
        for source in self._all:
            source.forget()

    def are_current(self) -> bool:
        """Whether each had an observation within its `expected_update_rate`."""
        return all(source.is_current() for source in self._all)

    def ages(self) -> list[MessageAge]:
        """Of each; of those that share a topic, of the one longest without usable data."""
        found: dict[str, MessageAge] = {}
        for ages in (source.ages() for source in self._all):
            known = found.get(ages.what)
            if known is None or abs(ages.placed) > abs(known.placed):
                found[ages.what] = ages
        return list(found.values())

    def observe(self, layers: Sequence[Layer]) -> None:
        """Passes each layer its sources' observations, for marking and for clearing."""
        for layer in layers:
            if isinstance(layer, ObstacleLayer):
                seen = [(each.settings, each.collect()) for each in self._of_layers[layer.name]]
                layer.observe(*([observation for settings, observations in seen if settings[use]
                                 for observation in observations]
                                for use in ("marking", "clearing")))

"""Checks whether the data needed to drive is there, and logs one line on what is missing."""

from __future__ import annotations

from dataclasses import dataclass

import rospy
import tf2_ros

from costmap_2d import CostmapROS
from costmap_2d.sources import MessageAge
from move_base.base import Base
from nav_nodes.missing_data import MissingData

STANDS = "the robot stands until it is there again"
PAUSE = 1.0  # s between two checks; after a longer one, e.g. between goals, old data is dropped


@dataclass
class _Seen:
    """The localisation's newest stamp, when it was first seen, and when it was last checked."""

    stamp: rospy.Time
    since: float
    looked: float


class Watch:
    """Checks costmaps, sensors, transforms and odometry. Called by one thread."""

    def __init__(self, costmaps: tuple[CostmapROS, CostmapROS], base: Base,
                 buffer: tf2_ros.Buffer, missing_data: MissingData) -> None:
        """`costmaps`: the global and the local one."""
        self._costmaps, self._base, self._buffer = costmaps, base, buffer
        self._missing_data = missing_data
        self._seen: _Seen | None = None
        self._orphaned: set[str] = set()

    def can_drive(self, now: float, timeout: float, map_required: bool) -> bool:
        """Whether all is there at `now`, s of ROS time; data older than `timeout`, s, is missing.

        With `map_required`, so is a map whose publisher has gone.

        With a timeout of 0 it requires, as upstream, only costmaps, poses and sensors that have an
        `expected_update_rate`, and that no odometry was refused.
        """
        poses = [costmap.robot_pose() for costmap in self._costmaps]  # both, so that both complain
        located = all(pose is not None for pose in poses)
        return ((self._all_speak(now, timeout, located) if timeout > 0.0
                 else self._odometry_can_be()) and located
                and not (map_required and self._miss_maps())
                and all(costmap.is_ready() for costmap in self._costmaps)
                and self._sensors_are_current())

    def _all_speak(self, now: float, timeout: float, located: bool) -> bool:
        """Whether sensors, odometry and localisation are alive; logs each that is not.

        Without odometry there is no localisation either, and only odometry is named.
        """
        return all([self._sensors_speak(timeout), self._odometry_speaks(now, timeout),
                    not located or self._is_localised(now, timeout)])

    def _miss_maps(self) -> bool:
        """Whether a map has no publisher; logs each such map."""
        orphaned = {topic for costmap in self._costmaps for topic in costmap.orphaned_maps()}
        for topic in self._orphaned | orphaned:
            self._say(f"publisher of the map on {topic}", topic in orphaned)
        self._orphaned = orphaned
        return bool(orphaned)

    def _sensors_are_current(self) -> bool:
        if self._costmaps[1].is_current():
            return True
        rospy.logwarn_throttle(
            5.0, f"[{rospy.get_name()}]:Sensor data is out of date, we're not going to allow "
                 "commanding of the base for safety")
        return False

    def _sensors_speak(self, timeout: float) -> bool:
        speaking = [self._speaks(ages, timeout) for ages in self._costmaps[1].ages()]
        return all(speaking)  # a list, so that each silent one is logged

    def _speaks(self, ages: MessageAge, timeout: float) -> bool:
        """Whether a sensor sends usable data. A missing transform is logged separately."""
        silent = abs(ages.heard) > timeout  # below 0: heard before the clock was set back
        useless = not silent and abs(ages.placed) > timeout
        self._say(ages.what, silent)
        if ages.why or not useless:
            self._say(ages.usable, useless, ages.why)
        return not (silent or useless)

    def _odometry_speaks(self, now: float, timeout: float) -> bool:
        heard = self._base.heard
        silent = heard is None or abs(now - heard.to_sec()) > timeout
        self._say(f"odometry on {self._base.odom_topic}", silent, self._base.odometry_fault)
        return not silent

    def _odometry_can_be(self) -> bool:
        fault = self._base.odometry_fault
        self._say(f"odometry on {self._base.odom_topic}", bool(fault), fault)
        return not fault

    def _is_localised(self, now: float, timeout: float) -> bool:
        """Whether the transform from map to odometry frame is still being published."""
        parent, child = (costmap.global_frame for costmap in self._costmaps)
        if parent == child:
            return True
        try:
            stamp = self._buffer.lookup_transform(parent, child, rospy.Time(0)).header.stamp
        except tf2_ros.TransformException:
            return False  # the costmaps log it
        if stamp.is_zero():
            return True  # it is a static transform
        if self._seen is None or now - self._seen.looked > PAUSE or stamp != self._seen.stamp:
            self._seen = _Seen(stamp, now, now)
        self._seen.looked = now
        late = now - self._seen.since > timeout
        self._say(f"new transform from {parent} to {child}", late, is_result=True)
        return not late

    def _say(self, what: str, missing: bool, why: str = "", is_result: bool = False) -> None:
        if missing:
            self._missing_data.missing(what, f"{why}; {STANDS}" if why else STANDS,
                                       is_result=is_result)
        else:
            self._missing_data.present(what)

"""The node fake_localization."""

from __future__ import annotations

import threading
import time
from collections import deque

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry

from fake_localization.poses import (
    map_to_odom,
    matrix_of,
    offset,
    pose_of,
    transform_matrix,
    transform_of,
)
from nav_nodes.broadcasting import SoleBroadcaster
from nav_nodes.missing_data import MissingData, is_published, watch_clock, why_silent
from nav_nodes.program import run_node
from nav_nodes.transforms import NEWEST, Transforms

WAITING = 100  # poses that wait for the odometry of their moment, at most; upstream's number
POLL = 0.01    # s of wall time
QUIET = 1.0    # s of wall time without a pose until that is noticed


class FakeLocalization:
    """True poses come in; the same go out as amcl's, with the transform from map to odom.

    As upstream: the frame of what comes in is not looked at, and an initial pose in another frame
    than the map's is a warning but counts. When the clock is set back it starts again.
    """

    def __init__(self, values: dict) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._map, self._odom, self._base = (
            values[name].lstrip("/")
            for name in ("global_frame_id", "odom_frame_id", "base_frame_id"))
        self._ahead = rospy.Duration.from_sec(values["transform_tolerance"])
        self._offset = offset(values["delta_x"], values["delta_y"], values["delta_yaw"])
        self._missing_data = MissingData()
        watch_clock(self._missing_data)
        self._transforms = Transforms(self._missing_data, (self._odom, self._base))
        self._waiting: deque[Odometry] = deque(maxlen=WAITING)
        self._came = threading.Condition()
        self._newest, self._sent = rospy.Time(0), None
        self._pose_topic = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=1,
                                           latch=True)
        self._particle_topic = rospy.Publisher("particlecloud", PoseArray, queue_size=1, latch=True)
        self._broadcaster = SoleBroadcaster()
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._take_initial_pose)
        self._truth = rospy.Subscriber("base_pose_ground_truth", Odometry, self._take_truth,
                                       queue_size=WAITING)

    def run(self) -> None:
        """Until the node is told to end."""
        last = time.monotonic()
        missing = f"true poses on {self._truth.resolved_name}"
        while not rospy.is_shutdown():
            with self._came:
                came = self._waiting or self._came.wait(QUIET / 4)
            if came:
                last = time.monotonic()
                self._missing_data.present(missing)
                self._publish_what_is_ready()
            elif time.monotonic() - last > QUIET:
                self._missing_data.missing(missing, self._why_no_truth(), since=last)

    def _take_truth(self, truth: Odometry) -> None:
        with self._came:
            if truth.header.stamp < self._newest:
                rospy.logwarn("the clock went back by %.1f s: starting again",
                              (self._newest - truth.header.stamp).to_sec())
                self._waiting.clear()
                self._transforms.buffer.clear()
            self._newest = truth.header.stamp
            self._waiting.append(truth)
            self._came.notify()

    def _publish_what_is_ready(self) -> None:
        """All whose odometry has come, the oldest first; the others go on waiting."""
        frames = self._odom, self._base
        if self._transforms.buffer.can_transform(*frames, NEWEST):
            latest = self._transforms.buffer.get_latest_common_time(*frames)
            while truth := self._next(latest):
                self._publish(truth)
        if self._waiting:
            self._transforms.find(*frames, self._newest)  # says what is missing
            time.sleep(POLL)

    def _next(self, latest: rospy.Time) -> Odometry | None:
        """The oldest waiting odometry, unless it is newer than `latest` (0: any)."""
        with self._came:
            is_ready = self._waiting and (latest.is_zero()
                                          or self._waiting[0].header.stamp <= latest)
            return self._waiting.popleft() if is_ready else None

    def _publish(self, truth: Odometry) -> None:
        try:
            base = self._offset @ matrix_of(truth.pose.pose)
        except ValueError as error:
            self._missing_data.missing("true pose that is one", str(error))
            return
        self._missing_data.present("true pose that is one")
        odometry = self._transforms.find(self._odom, self._base, truth.header.stamp)
        if odometry is None:  # older than all odometry
            return
        estimate = PoseWithCovarianceStamped(header=truth.header, pose=truth.pose)
        estimate.header.frame_id = self._map
        estimate.pose.pose = pose_of(base)
        self._pose_topic.publish(estimate)
        self._particle_topic.publish(PoseArray(estimate.header, [estimate.pose.pose]))
        self._broadcast(map_to_odom(base, transform_matrix(odometry)), truth.header.stamp)

    def _broadcast(self, matrix: np.ndarray, stamp: rospy.Time) -> None:
        if stamp == self._sent:  # the same stamp twice is a warning in every listener
            return
        self._sent = stamp
        message = TransformStamped(child_frame_id=self._odom, transform=transform_of(matrix))
        message.header.frame_id, message.header.stamp = self._map, stamp + self._ahead
        self._broadcaster.sendTransform(message)

    def _take_initial_pose(self, wanted: PoseWithCovarianceStamped) -> None:
        """The robot is moved on the map, by a shift of the map: from now on it is there."""
        if wanted.header.frame_id.lstrip("/") != self._map:
            rospy.logwarn("initialpose is in frame %r, not in %r; it is taken as if it were",
                          wanted.header.frame_id, self._map)
        try:
            pose = matrix_of(wanted.pose.pose)
            found = self._transforms.buffer.lookup_transform(self._map, self._base, rospy.Time(0))
        except ValueError as error:
            rospy.logwarn("initialpose: %s; nothing is changed", error)
        except tf2_ros.TransformException as error:
            rospy.logwarn("initialpose: nothing is changed, because the robot is not on the map "
                          "yet: %s", " ".join(str(error).split()))
        else:
            self._offset = pose @ np.linalg.inv(transform_matrix(found.transform)) @ self._offset

    def _why_no_truth(self) -> str:
        """What may be wrong, as far as this process can tell."""
        if is_published(self._truth):
            return why_silent(self._truth, "base_pose_ground_truth")
        return ("nobody publishes there nav_msgs/Odometry; has the robot the plugin "
                "libgazebo_ros_p3d.so with that <topicName>?")


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    return run_node("fake_localization", "fake_localization", "params/fake_localization.yaml",
                    lambda values, _: FakeLocalization(values).run())

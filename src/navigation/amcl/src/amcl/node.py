"""The node amcl."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import SetMap, SetMapRequest, SetMapResponse
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from amcl.conversions import known_pose, scan_of
from amcl.initial_pose import SAVED, carried_on, initial_pose, save_pose, saved_pose
from amcl.maps import MapSource, grid_in
from amcl.outputs import Outputs
from amcl.robot_frames import RobotFrames
from amcl.settings import localisation_settings, sensor_settings, with_order
from nav_algorithms import poses
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.monte_carlo import Localisation, Step
from nav_nodes.missing_data import MissingData, TopicWatchdog, watch_clock
from nav_nodes.parameters import serve_changes
from nav_nodes.program import run_node

SCAN_PATIENCE = 0.5               # s of wall time to wait for a scan's odometry
DISORDER = 1.0                    # s by which scans of two lasers may be out of order
WATCH = 0.25                      # s of wall time between two checks for missing inputs


class AmclNode:
    """Takes scans, a map and transforms; publishes the pose and the transform from map to odom.

    All state changes under one lock, because scans, services and maps come on threads of their own.
    """

    def __init__(self, values: dict[str, Any], table: list) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._values = with_order(values)
        self._lock = threading.RLock()
        self._random = np.random.default_rng(values["seed"])
        self._missing_data = MissingData()
        watch_clock(self._missing_data)
        self._frames = RobotFrames(self._values, self._missing_data)
        self._grid: OccupancyGrid | None = None
        self._localisation: Localisation | None = None
        self._told: tuple[np.ndarray, np.ndarray] | None = None  # by initialpose, before a map
        self._saved: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None  # with its odometry
        self._odometry: np.ndarray | None = None
        self._newest = rospy.Time(0)
        self._watchdog = TopicWatchdog(self._missing_data, "laser scans", "scan")
        self._is_tracking = False  # the transform map to odom is known
        self._has_jumped = False   # the clock went back: follow the next scan's odometry
        self._outputs = Outputs()
        self._maps = MapSource(self._take_map, self._missing_data)
        rospy.Service("global_localization", Empty, self._start_anywhere)
        rospy.Service("request_nomotion_update", Empty, self._weigh_next)
        rospy.Service("set_map", SetMap, self._set_map)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._take_pose, queue_size=2)
        self._scans = rospy.Subscriber("scan", LaserScan, self._take_scan, queue_size=5)
        serve_changes(table, self._values, self._change)
        threading.Thread(target=self._watch, daemon=True).start()

    # The map, and where the robot starts on it

    def _take_map(self, message: OccupancyGridMessage) -> None:
        """Raises ValueError, and changes nothing, if the map is invalid."""
        grid = grid_in(message, self._values["global_frame_id"])
        with self._lock:
            self._grid = grid
            told, self._told = self._told, None
            self._begin(*(told or initial_pose(self._values)))
            if told is None and self._values["resume_by_odometry"]:
                self._saved = saved_pose(self._values)

    def _begin(self, pose: np.ndarray, covariance: np.ndarray) -> None:
        """New particles on the map with the current settings."""
        self._localisation = Localisation(self._grid, localisation_settings(self._values),
                                          sensor_settings(self._values), self._random)
        self._localisation.start_at(pose, covariance)
        self._is_tracking = False
        self._saved = self._odometry = None

    def _set_map(self, request: SetMapRequest) -> SetMapResponse:
        if not self._maps.set(request.map):
            return SetMapResponse(False)
        self._take_pose(request.initial_pose)
        with self._lock:
            if self._values["force_update_after_set_map"] and self._localisation is not None:
                self._localisation.weigh_next()
        return SetMapResponse(True)

    def _take_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Takes an initial pose; one with an older stamp is moved by the odometry since then."""
        frame, ours = message.header.frame_id.lstrip("/"), self._values["global_frame_id"]
        if not frame:
            rospy.logwarn("initialpose without a frame_id: taken to be in %s", ours)
        elif frame != ours.lstrip("/"):
            rospy.logwarn("Ignoring initial pose in frame \"%s\"; initial poses must be in the "
                          "global frame, \"%s\"", frame, ours)
            return
        try:
            pose, covariance = known_pose(message)
        except ValueError as error:
            rospy.logwarn("initialpose passed over: %s", error)
            return
        pose = poses.compose(pose, self._frames.moved_since(message.header.stamp))
        rospy.loginfo("Setting pose (%.6f): %.3f %.3f %.3f", rospy.Time.now().to_sec(), *pose)
        with self._lock:
            if self._localisation is None:
                self._told = pose, covariance
                return
            self._localisation.start_at(pose, covariance)
            self._saved = self._odometry = None
            if self._values["force_update_after_initialpose"]:
                self._localisation.weigh_next()

    def _start_anywhere(self, _request: EmptyRequest) -> EmptyResponse:
        with self._lock:
            if self._localisation is not None:
                rospy.loginfo("Initializing with uniform distribution")
                self._localisation.start_anywhere()
                self._saved = self._odometry = None
        return EmptyResponse()

    def _weigh_next(self, _request: EmptyRequest) -> EmptyResponse:
        with self._lock:
            if self._localisation is not None:
                self._localisation.weigh_next()
        return EmptyResponse()

    def _change(self, values: dict[str, Any]) -> dict[str, Any]:
        """dynamic_reconfigure: as upstream, particles are drawn anew around the current pose."""
        values = with_order(values)
        with self._lock:
            before, self._values = self._values, values
            self._frames.rename(values)
            self._maps.follow(values["use_map_topic"], values["first_map_only"])
            if self._localisation is not None and any(
                    made(before) != made(values)
                    for made in (localisation_settings, sensor_settings)):
                estimate = self._localisation.estimate
                self._begin(estimate.pose, estimate.covariance)
        return values

    # Scans

    def _take_scan(self, message: LaserScan) -> None:
        with self._watchdog.heard():
            if self._localisation is not None:
                self._use_scan(message)

    def _use_scan(self, message: LaserScan) -> None:
        stamp = message.header.stamp
        with self._lock:
            self._look_at_clock(stamp)
        mount = self._frames.mount(message.header.frame_id)
        odometry = self._frames.odometry(stamp, SCAN_PATIENCE)
        if mount is None or odometry is None:
            return
        what = f"usable scan on {self._scans.resolved_name}"
        try:
            scan = scan_of(message, mount, self._values["laser_min_range"],
                           self._values["laser_max_range"])
        except ValueError as error:
            self._missing_data.missing(what, str(error))
            return
        self._missing_data.present(what)
        with self._lock:
            if stamp > self._newest:  # the clock went back while this one waited for its odometry
                return
            if self._saved is not None:
                self._localisation.start_at(*carried_on(*self._saved, odometry))
            elif self._has_jumped:
                self._localisation.jump_to(odometry)
            self._saved, self._odometry, self._has_jumped = None, odometry, False
            self._publish(self._localisation.add(odometry, scan, message.header.frame_id), stamp)

    def _look_at_clock(self, stamp: rospy.Time) -> None:
        """If the clock went back (reset simulation), take the robot to be where its odometry is."""
        behind = (self._newest - stamp).to_sec()
        if not 0.0 < behind <= DISORDER:
            self._newest = stamp
        if behind <= DISORDER:
            return
        rospy.logwarn("the clock went back by %.1f s: the robot is taken to be where its odometry "
                      "is now; if not, set its pose (2D Pose Estimate in rviz)", behind)
        self._frames.clear()
        self._has_jumped = True
        self._outputs.restart()

    def _publish(self, step: Step, stamp: rospy.Time) -> None:
        found, values = self._localisation, self._values
        if step.weighed:
            self._outputs.cloud(found.particles, values)
        if step.estimated:
            self._outputs.pose(found.estimate, values, stamp)
            self._is_tracking = True
        if self._is_tracking and values["tf_broadcast"]:
            self._outputs.transform(found.map_to_odom, values, stamp)

    # Independent of scans

    def _watch(self) -> None:
        """Logs what is missing, saves the pose, and publishes its certainty to /diagnostics."""
        saved = told = time.monotonic()
        while not rospy.is_shutdown():
            time.sleep(WATCH)
            now, rate = time.monotonic(), self._values["save_pose_rate"]
            self._maps.complain()
            self._watchdog.look(self._scans)
            with self._lock:
                if not self._is_tracking or self._odometry is None:
                    continue
                covariance, odometry = self._localisation.estimate.covariance, self._odometry
                pose = poses.compose(self._localisation.map_to_odom, odometry)
            if rate > 0 and now - saved >= 1.0 / rate:
                saved = now
                save_pose(pose, covariance, odometry)
            if now - told >= 1.0:
                told = now
                self._outputs.diagnostics(covariance, self._values)


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    return run_node("amcl", "amcl", "params/amcl.yaml", AmclNode, [SAVED.lstrip("~")])

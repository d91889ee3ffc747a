"""The node amcl."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import rospkg
import rospy
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.srv import SetMap, SetMapRequest, SetMapResponse
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from amcl.conversions import ParticleCloud, known_pose, pose_with_covariance, scan_of
from amcl.diagnostics import deviations
from amcl.initial_pose import initial_pose, save_pose
from amcl.maps import MapSource
from amcl.robot_frames import RobotFrames
from amcl.settings import localisation_settings, sensor_settings, with_order
from nav_algorithms import poses
from nav_algorithms.grid import OccupancyGrid
from nav_algorithms.monte_carlo import Localisation, Step
from nav_nodes.complaints import Complaints
from nav_nodes.messages import grid_of, transform_message
from nav_nodes.parameters import ParameterError, load_table, read_parameters, serve_changes

TABLE = Path("params/amcl.yaml")  # below the package's folder
SCAN_PATIENCE = 0.5               # s of wall time that a scan waits for its odometry
WATCH = 0.25                      # s of wall time between two looks at what is missing


class AmclNode:
    """Scans, a map and transforms come in; the pose and the transform map to odom go out.

    All state changes under one lock, because scans, services and maps come on threads of their own.
    """

    def __init__(self, values: dict[str, Any], table: list) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._start_values = self._values = with_order(values)
        self._lock = threading.RLock()
        self._random = np.random.default_rng(values["seed"])
        self._complaints = Complaints()
        self._frames = RobotFrames(self._values, self._complaints)
        self._grid: OccupancyGrid | None = None
        self._localisation: Localisation | None = None
        self._told: tuple[np.ndarray, np.ndarray] | None = None  # by initialpose, before the map
        self._newest = self._last_cloud = rospy.Time(0)
        self._last_scan = time.monotonic()
        self._is_tracking = False  # the transform map to odom is known
        self._pose_topic = rospy.Publisher("amcl_pose", PoseWithCovarianceStamped, queue_size=2,
                                           latch=True)
        self._cloud_topic = rospy.Publisher("particlecloud", PoseArray, queue_size=2)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=2)
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._maps = MapSource(self._take_map, self._complaints)
        rospy.Service("global_localization", Empty, self._start_anywhere)
        rospy.Service("request_nomotion_update", Empty, self._weigh_next)
        rospy.Service("set_map", SetMap, self._set_map)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._take_pose, queue_size=2)
        self._scans = rospy.Subscriber("scan", LaserScan, self._take_scan, queue_size=5)
        serve_changes(table, self._values, self._change)
        threading.Thread(target=self._watch, daemon=True).start()

    # The map, and where the robot starts on it

    def _take_map(self, message: OccupancyGridMessage) -> None:
        frame = self._values["global_frame_id"].lstrip("/")
        if message.header.frame_id.lstrip("/") != frame:
            rospy.logwarn("the map's frame is %r, but ~global_frame_id is %r: what is published "
                          "may not fit it", message.header.frame_id, frame)
        try:
            grid = grid_of(message)
        except ValueError as error:
            rospy.logerr("a map came that is none, passed over: %s", error)
            return
        rospy.loginfo("Received a %d X %d map @ %.3f m/pix", *grid.cells.shape[::-1],
                      grid.resolution)
        with self._lock:
            self._grid = grid
            self._begin(*(self._told or initial_pose(self._values)))
            self._told = None

    def _begin(self, pose: np.ndarray, covariance: np.ndarray) -> None:
        """New particles on the map with the present settings."""
        self._localisation = Localisation(self._grid, localisation_settings(self._values),
                                          sensor_settings(self._values), self._random)
        self._localisation.start_at(pose, covariance)
        self._is_tracking = False

    def _set_map(self, request: SetMapRequest) -> SetMapResponse:
        self._maps.set(request.map)
        self._take_pose(request.initial_pose)
        with self._lock:
            if self._values["force_update_after_set_map"] and self._localisation is not None:
                self._localisation.weigh_next()
        return SetMapResponse(True)

    def _take_pose(self, message: PoseWithCovarianceStamped) -> None:
        """A pose of the past is moved by what the odometry says was driven since."""
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
            if self._values["force_update_after_initialpose"]:
                self._localisation.weigh_next()

    def _start_anywhere(self, _request: EmptyRequest) -> EmptyResponse:
        with self._lock:
            if self._localisation is not None:
                rospy.loginfo("Initializing with uniform distribution")
                self._localisation.start_anywhere()
        return EmptyResponse()

    def _weigh_next(self, _request: EmptyRequest) -> EmptyResponse:
        with self._lock:
            if self._localisation is not None:
                self._localisation.weigh_next()
        return EmptyResponse()

    def _change(self, values: dict[str, Any]) -> dict[str, Any]:
        """dynamic_reconfigure: as upstream, the particles begin anew round the present pose."""
        if values["restore_defaults"]:
            values = {**self._start_values, "restore_defaults": False}
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
        self._last_scan = time.monotonic()
        self._complaints.present(self._scans_missing)
        if self._localisation is None:
            return
        stamp = message.header.stamp
        if stamp < self._newest:
            self._restart(self._newest - stamp)
        self._newest = stamp
        mount = self._frames.mount(message.header.frame_id)
        odometry = self._frames.odometry(stamp, SCAN_PATIENCE)
        if mount is None or odometry is None:
            return
        what = f"usable scan on {self._scans.resolved_name}"
        try:
            scan = scan_of(message, mount, self._values["laser_min_range"],
                           self._values["laser_max_range"])
        except ValueError as error:
            self._complaints.missing(what, str(error))
            return
        self._complaints.present(what)
        with self._lock:
            self._publish(self._localisation.add(odometry, scan, message.header.frame_id), stamp)

    def _restart(self, by: rospy.Duration) -> None:
        rospy.logwarn("the clock went back by %.1f s: the robot is taken to stand where it was",
                      by.to_sec())
        self._frames.clear()
        with self._lock:
            self._localisation.forget_odometry()
            self._last_cloud = rospy.Time(0)

    def _publish(self, step: Step, stamp: rospy.Time) -> None:
        frame = self._values["global_frame_id"].lstrip("/")
        if step.weighed:
            self._publish_cloud(frame)
        if step.estimated:
            message = pose_with_covariance(self._localisation.estimate)
            message.header.frame_id, message.header.stamp = frame, stamp
            self._pose_topic.publish(message)
            self._is_tracking = True
        if self._is_tracking and self._values["tf_broadcast"]:
            ahead = rospy.Duration.from_sec(self._values["transform_tolerance"])
            self._broadcaster.sendTransform(transform_message(
                self._localisation.map_to_odom, frame,
                self._values["odom_frame_id"].lstrip("/"), stamp + ahead))

    def _publish_cloud(self, frame: str) -> None:
        now, rate = rospy.Time.now(), self._values["gui_publish_rate"]
        if not self._cloud_topic.get_num_connections() or (
                rate > 0 and (now - self._last_cloud).to_sec() < 1.0 / rate):
            return
        self._last_cloud = now
        cloud = ParticleCloud(self._localisation.particles)
        cloud.header.frame_id, cloud.header.stamp = frame, now
        self._cloud_topic.publish(cloud)

    # What does not wait for a scan

    def _watch(self) -> None:
        """Says what is missing, saves the pose, and tells /diagnostics how sure it is."""
        saved = told = time.monotonic()
        while not rospy.is_shutdown():
            time.sleep(WATCH)
            now, rate = time.monotonic(), self._values["save_pose_rate"]
            self._maps.complain()
            if now - self._last_scan > 1.0:
                self._complaints.missing(self._scans_missing, self._why_no_scans())
            if not self._is_tracking:
                continue
            estimate = self._localisation.estimate
            if rate > 0 and now - saved >= 1.0 / rate:
                saved = now
                save_pose(estimate)
            if now - told >= 1.0:
                told = now
                self._diagnostics.publish(deviations(estimate.covariance, self._values))

    @property
    def _scans_missing(self) -> str:
        return f"laser scans on {self._scans.resolved_name}"

    def _why_no_scans(self) -> str:
        """What may be wrong, as far as this process can tell."""
        if rospy.Time.now().is_zero():
            return "the simulated clock /clock does not run, is the simulator started?"
        if not self._scans.get_num_connections():
            return "nobody publishes there sensor_msgs/LaserScan (rostopic info, scan:=TOPIC)"
        return "its publisher is silent, is the simulation paused?"


def main() -> None:
    """Runs the node until it is told to end."""
    rospy.init_node("amcl")
    table = load_table(Path(rospkg.RosPack().get_path("amcl")) / TABLE)
    try:
        AmclNode(read_parameters(table), table)
    except ParameterError as error:
        rospy.logfatal("%s", error)
        raise SystemExit(1) from None
    rospy.spin()

"""The node hector_mapping."""

from __future__ import annotations

import threading
import time
from dataclasses import fields

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from nav_msgs.msg import MapMetaData, OccupancyGrid, Odometry
from nav_msgs.srv import GetMap, GetMapRequest, GetMapResponse
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from nav_algorithms import poses
from nav_algorithms.scan_slam import ScanSlam, ScanSlamSettings
from nav_nodes.broadcasting import SoleBroadcaster
from nav_nodes.laser_mount import Mount, Mounts
from nav_nodes.messages import MapAnswer, grid_message, pose_of, stamped_pose, transform_message
from nav_nodes.missing_data import MissingData, TopicWatchdog, watch_clock
from nav_nodes.program import run_node
from nav_nodes.transforms import Transforms

PATIENCE = 0.5  # s of wall time to wait for a scan's transforms
BEYOND = 0.01   # m below the sensor's maximum, from which on a range counts as no return
PLANAR = np.ix_((0, 1, 5), (0, 1, 5))  # x, y and yaw in a covariance (6, 6)


def hits_of(scan: LaserScan, mount: Mount, nearest: float,
            farthest: float) -> tuple[np.ndarray, np.ndarray]:
    """Ends (N, 2), m, of a scan's beams that hit, in the robot's frame, and their ranges (N,)."""
    ranges = np.array(scan.ranges, float)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    with np.errstate(invalid="ignore"):
        hit = (np.isfinite(angles) & (ranges >= max(scan.range_min, nearest)) & (ranges <= farthest)
               & (ranges < scan.range_max - BEYOND))
    ranges, angles = ranges[hit], (-angles if mount.upside_down else angles)[hit]
    ends = ranges[:, None] * np.column_stack((np.cos(angles), np.sin(angles)))
    return poses.transform_points(mount.pose, ends), ranges


class HectorMapping:
    """Takes scans; publishes map, pose, and the transforms from the map."""

    def __init__(self, values: dict) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._values = values
        self._map_frame, self._odom_frame, self._base_frame = (
            values[name].lstrip("/") for name in ("map_frame", "odom_frame", "base_frame"))
        self._lock = threading.Lock()
        self._missing_data = MissingData()
        watch_clock(self._missing_data)
        self._transforms = Transforms(self._missing_data, (self._odom_frame, self._base_frame))
        self._mounts = Mounts(self._base_frame, self._transforms, self._missing_data)
        self._watchdog = TopicWatchdog(self._missing_data, "laser scans", values["scan_topic"])
        self._broadcaster = SoleBroadcaster()
        self._sent = rospy.Time(0)
        self._reset()
        self._map_topic = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._metadata_topic = rospy.Publisher("map_metadata", MapMetaData, queue_size=1,
                                               latch=True)
        self._pose_topic = rospy.Publisher("slam_out_pose", PoseStamped, queue_size=1)
        self._update_topic = rospy.Publisher(values["pose_update_topic"],
                                             PoseWithCovarianceStamped, queue_size=1)
        self._odometry_topic = (rospy.Publisher("scanmatch_odom", Odometry, queue_size=50)
                                if values["pub_odometry"] else None)
        if values["advertise_map_service"]:
            rospy.Service("dynamic_map", GetMap, self._answer_map)
        rospy.Service("reset_map", Trigger, self._answer_reset)
        rospy.Subscriber("initialpose", PoseWithCovarianceStamped, self._take_initial_pose)
        rospy.Subscriber(values["sys_msg_topic"], String, self._take_command, queue_size=2)
        self._scans = rospy.Subscriber(values["scan_topic"], LaserScan, self._take_scan,
                                       queue_size=values["scan_subscriber_queue_size"])
        threading.Thread(target=self._publish_maps, daemon=True).start()

    def _reset(self) -> None:
        with self._lock:
            self._slam = ScanSlam(ScanSlamSettings(**{
                field.name: self._values[field.name] for field in fields(ScanSlamSettings)}))

    def _take_command(self, command: String) -> None:
        if command.data == "reset":
            rospy.loginfo("the map is reset")
            self._reset()

    def _answer_reset(self, _request: TriggerRequest) -> TriggerResponse:
        self._reset()
        return TriggerResponse(success=True)

    def _take_initial_pose(self, wanted: PoseWithCovarianceStamped) -> None:
        pose = pose_of(wanted.pose.pose)
        if not np.isfinite(pose).all():
            rospy.logwarn("initialpose holds nan or inf; nothing is changed")
            return
        with self._lock:
            self._slam.place(pose)

    def _take_scan(self, scan: LaserScan) -> None:
        begun = time.monotonic()
        with self._watchdog.heard():
            if scan.header.stamp < self._sent:
                rospy.logwarn("the clock went back by %.1f s: mapping goes on from there",
                              (self._sent - scan.header.stamp).to_sec())
                self._transforms.buffer.clear()
            mount = self._mount(scan.header.frame_id)
            if mount is None:
                return
            guess = None
            if self._values["use_tf_pose_start_estimate"]:
                guess = self._transforms.pose(self._map_frame, self._base_frame,
                                              scan.header.stamp, PATIENCE)
            with self._lock:
                pose, covariance = self._match(scan, mount, guess)
            self._publish_pose(pose, covariance, scan.header.stamp)
            self._send_transforms(pose, scan.header.stamp)
        if self._values["output_timing"]:
            rospy.loginfo("HectorSLAM Iter took: %f milliseconds",
                          1e3 * (time.monotonic() - begun))

    def _mount(self, frame: str) -> Mount | None:
        if not self._values["use_tf_scan_transformation"]:
            return Mount(np.zeros(3), False)
        return self._mounts.of(frame)

    def _match(self, scan: LaserScan, mount: Mount,
               guess: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
        ends, ranges = hits_of(scan, mount, self._values["laser_min_dist"],
                               self._values["laser_max_dist"])
        fits = self._slam.add(scan.header.stamp.to_sec(), ends, ranges, abs(scan.angle_increment),
                              mount.pose[:2], guess)
        what = "scan that fits the map"
        if fits:
            self._missing_data.present(what)
        else:
            self._missing_data.missing(what, f"the pose stays where it was; {len(ends)} beams hit "
                                           "something, and too few of those a wall of the map")
        return self._slam.pose, self._slam.covariance

    def _publish_pose(self, pose: np.ndarray, covariance: np.ndarray, stamp: rospy.Time) -> None:
        placed = stamped_pose(pose, self._map_frame, stamp)
        whole = np.zeros((6, 6))
        whole[PLANAR] = covariance
        update = PoseWithCovarianceStamped(header=placed.header)
        update.pose.pose, update.pose.covariance = placed.pose, whole.ravel().tolist()
        self._pose_topic.publish(placed)
        self._update_topic.publish(update)
        if self._odometry_topic:
            self._odometry_topic.publish(Odometry(header=placed.header, pose=update.pose))

    def _send_transforms(self, pose: np.ndarray, stamp: rospy.Time) -> None:
        if stamp == self._sent:  # a repeated stamp makes every listener warn
            return
        self._sent = stamp
        sent = []
        if self._values["pub_map_odom_transform"]:
            odometry = np.zeros(3)
            if self._odom_frame != self._base_frame:
                found = self._transforms.pose(self._odom_frame, self._base_frame, stamp, PATIENCE)
                odometry = odometry if found is None else found  # as upstream, which logs it, too
            sent.append(transform_message(poses.compose(pose, poses.invert(odometry)),
                                          self._map_frame, self._odom_frame, stamp))
        if self._values["pub_map_scanmatch_transform"]:
            sent.append(transform_message(
                pose, self._map_frame,
                self._values["tf_map_scanmatch_transform_frame_name"].lstrip("/"), stamp))
        self._broadcaster.sendTransform(sent)

    def _newest_map(self) -> OccupancyGrid:
        with self._lock:
            grid = self._slam.grid()
        return grid_message(grid, self._map_frame, rospy.Time.now())

    def _answer_map(self, _request: GetMapRequest) -> GetMapResponse:
        return MapAnswer(self._newest_map())

    def _publish_maps(self) -> None:
        """Publishes the map at a wall-clock rate, and checks whether scans still come."""
        due = time.monotonic()
        while not rospy.is_shutdown():
            if time.monotonic() >= due:
                due = time.monotonic() + self._values["map_pub_period"]
                newest = self._newest_map()
                self._map_topic.publish(newest)
                self._metadata_topic.publish(newest.info)
            self._watchdog.look(self._scans)
            time.sleep(min(self._values["map_pub_period"], 0.5))


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    return run_node("hector_mapping", "hector_mapping", "params/hector_mapping.yaml",
                    lambda values, _: HectorMapping(values))

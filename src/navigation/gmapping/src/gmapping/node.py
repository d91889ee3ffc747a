"""The node slam_gmapping."""

from __future__ import annotations

import threading
import time

import numpy as np
import rospy
from nav_msgs.msg import MapMetaData, OccupancyGrid
from nav_msgs.srv import GetMap, GetMapRequest, GetMapResponse
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64

from gmapping.mapper import TABLE, Mapper, ScanError
from nav_nodes.broadcasting import SoleBroadcaster
from nav_nodes.laser_mount import Mount, Mounts
from nav_nodes.messages import MapAnswer, grid_message, transform_message
from nav_nodes.missing_data import MissingData, TopicWatchdog, watch_clock
from nav_nodes.program import run_node
from nav_nodes.transforms import Transforms

PATIENCE = 0.5  # s of wall time to wait for a scan's odometry
DISORDER = 1.0  # s by which scans of two lasers may be out of order


class SlamNode:
    """Takes scans and transforms; publishes the map and the transform from map to odom.

    When the clock is set back, upstream's node may fail; this one goes on with its map. Scans of
    two lasers come on two threads, and are mapped one at a time under a lock.
    """

    def __init__(self, values: dict) -> None:
        """`values` by the names of the parameter table; rospy is initialised."""
        self._values = values
        self._frames = {name: values[name].lstrip("/")
                        for name in ("map_frame", "odom_frame", "base_frame")}
        self._lock = threading.Lock()
        self._mapper = Mapper(values)
        self._missing_data = MissingData()
        watch_clock(self._missing_data)
        self._transforms = Transforms(self._missing_data, (self._frames["odom_frame"],
                                                           self._frames["base_frame"]))
        self._mounts = Mounts(self._frames["base_frame"], self._transforms, self._missing_data)
        self._map: OccupancyGrid | None = None
        self._map_to_odom = np.zeros(3)
        self._newest = rospy.Time(0)
        self._watchdog = TopicWatchdog(self._missing_data, "laser scans", "scan")
        self._map_topic = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)
        self._metadata_topic = rospy.Publisher("map_metadata", MapMetaData, queue_size=1,
                                               latch=True)
        self._entropy_topic = rospy.Publisher("~entropy", Float64, queue_size=1, latch=True)
        rospy.Service("dynamic_map", GetMap, self._answer_map)
        self._scans = rospy.Subscriber("scan", LaserScan, self._take_scan, queue_size=5)
        threading.Thread(target=self._broadcast, daemon=True).start()

    def _take_scan(self, scan: LaserScan) -> None:
        with self._watchdog.heard():
            with self._lock:
                is_wanted = self._mapper.is_wanted()
            if is_wanted:
                self._use_scan(scan)

    def _use_scan(self, scan: LaserScan) -> None:
        """Waits for the scan's odometry outside the lock, not to block another laser's scans."""
        with self._lock:
            self._look_at_clock(scan.header.stamp)
        mount = self._mounts.of(scan.header.frame_id)
        odometry = self._transforms.pose(self._frames["odom_frame"], self._frames["base_frame"],
                                         scan.header.stamp, PATIENCE)
        if mount is None or odometry is None:
            return
        with self._lock:
            if (scan.header.stamp - self._newest).to_sec() <= 0.0:  # else the clock went back
                self._map_scan(scan, odometry, mount)

    def _look_at_clock(self, stamp: rospy.Time) -> None:
        behind = (self._newest - stamp).to_sec()
        if behind > DISORDER:
            rospy.logwarn("the clock went back by %.1f s: mapping goes on from the odometry there",
                          behind)
            self._transforms.buffer.clear()
        if not 0.0 < behind <= DISORDER:
            self._newest = stamp

    def _map_scan(self, scan: LaserScan, odometry: np.ndarray, mount: Mount) -> None:
        try:
            if not self._mapper.take(scan, odometry, mount):
                return
        except ScanError as error:
            rospy.logwarn_throttle(5.0, "%s: %s", self._scans.resolved_name, error)
            return
        self._map_to_odom = self._mapper.slam.map_to_odom
        age = None if self._map is None else (scan.header.stamp - self._map.header.stamp).to_sec()
        if age is None or not -DISORDER <= age <= self._values["map_update_interval"]:
            self._publish_map(scan.header.stamp)

    def _publish_map(self, stamp: rospy.Time) -> None:
        self._map = grid_message(self._mapper.slam.grid(), self._frames["map_frame"], stamp)
        self._map_topic.publish(self._map)
        self._metadata_topic.publish(self._map.info)
        self._entropy_topic.publish(self._mapper.slam.entropy)

    def _answer_map(self, _request: GetMapRequest) -> GetMapResponse | None:
        """The newest map; the call fails while there is none, as in upstream."""
        return None if self._map is None else MapAnswer(self._map)

    def _broadcast(self) -> None:
        """Broadcasts the transform at a wall-clock rate, and checks whether scans still come."""
        period = self._values["transform_publish_period"]
        delay = self._values["tf_delay"] if self._values["tf_delay"] >= 0 else period
        broadcaster, last = SoleBroadcaster(), rospy.Time(0)
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            if period > 0 and now != last:  # a repeated stamp makes every listener warn
                broadcaster.sendTransform(transform_message(
                    self._map_to_odom, self._frames["map_frame"], self._frames["odom_frame"],
                    now + rospy.Duration.from_sec(delay)))
                last = now
            self._watchdog.look(self._scans)
            time.sleep(min(period, 0.5) or 0.5)


def main() -> int:
    """Runs the node until shutdown; returns the exit status."""
    return run_node("slam_gmapping", "gmapping", TABLE, lambda values, _: SlamNode(values))

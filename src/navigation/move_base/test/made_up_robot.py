"""A robot and its room without a simulator: it does what cmd_vel says until that says otherwise."""

from __future__ import annotations

import threading
import time

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Twist
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.poses import compose
from nav_algorithms.rays import cast
from nav_nodes.messages import grid_message, pose_message, transform_message

PERIOD = 1 / 30  # s
ANGLES = np.linspace(0.0, 2 * np.pi, 360, endpoint=False)
RANGE = 3.5      # m
LASER = np.array([-0.064, 0.0, 0.0])


def room() -> OccupancyGrid:
    """4 m x 4 m with walls, a column in the middle, and a closed chamber in the upper right."""
    cells = np.zeros((80, 80), np.int8)
    cells[:2] = cells[-2:] = 100
    cells[:, :2] = cells[:, -2:] = 100
    cells[36:44, 36:44] = 100
    cells[58:60, 56:] = cells[56:, 56:58] = 100
    return OccupancyGrid(cells, 0.05, (0.0, 0.0))


class Robot:
    """Publishes odom, scan, tf and localisation while `speaks` has them; keeps its last velocity.

    With localisation from the beginning it is its own map_server, too. `scan`: that topic's name.
    """

    def __init__(self, pose: tuple[float, float, float], *speaks: str, scan: str = "scan") -> None:
        self.pose, self.velocity = np.array(pose), np.zeros(3)
        self.speaks = set(speaks)
        self.commands = 0
        grid = room()
        self._occupied = (grid.cells > 50).astype(np.uint8)
        if "localisation" in speaks:
            self._map = rospy.Publisher("map", OccupancyGridMessage, queue_size=1, latch=True)
            self._map.publish(grid_message(grid, "map", rospy.Time.now()))
        self._odom = rospy.Publisher("odom", Odometry, queue_size=1)
        self._scan = rospy.Publisher(scan, LaserScan, queue_size=1)
        self._tf = tf2_ros.TransformBroadcaster()
        self._static = tf2_ros.StaticTransformBroadcaster()
        self._is_mounted = False
        rospy.Subscriber("cmd_vel", Twist, self._take, queue_size=1)
        threading.Thread(target=self._live, daemon=True).start()

    def stands(self) -> bool:
        """Whether it was told to."""
        return not self.velocity.any()

    def _take(self, message: Twist) -> None:
        self.velocity = np.array([message.linear.x, message.linear.y, message.angular.z])
        self.commands += 1

    def _live(self) -> None:
        tick = 0
        while not rospy.is_shutdown():
            self.pose = compose(self.pose, self.velocity * PERIOD)
            self._tell(rospy.Time.now(), tick)
            tick += 1
            time.sleep(PERIOD)

    def _tell(self, now: rospy.Time, tick: int) -> None:
        transforms = []
        if "tf" in self.speaks:
            self._tell_mount(now)
            transforms.append(transform_message(self.pose, "odom", "base_footprint", now))
        if "localisation" in self.speaks:
            transforms.append(transform_message(np.zeros(3), "map", "odom", now))
        self._tf.sendTransform(transforms)
        if "odom" in self.speaks:
            odometry = Odometry()
            odometry.header.stamp, odometry.header.frame_id = now, "odom"
            odometry.pose.pose = pose_message(self.pose)
            odometry.twist.twist.linear.x = self.velocity[0]
            odometry.twist.twist.angular.z = self.velocity[2]
            self._odom.publish(odometry)
        if "scan" in self.speaks and tick % 6 == 0:
            self._scan.publish(self._sweep(now))

    def _tell_mount(self, now: rospy.Time) -> None:
        """Once: it is latched."""
        if not self._is_mounted:
            self._is_mounted = True
            self._static.sendTransform(transform_message(LASER, "base_footprint", "base_scan", now))

    def _sweep(self, now: rospy.Time) -> LaserScan:
        laser = compose(self.pose, LASER)
        ranges = cast(self._occupied, 0.05, 0.0, 0.0, laser[0], laser[1], ANGLES + laser[2], RANGE)
        scan = LaserScan(angle_min=0.0, angle_max=2 * np.pi, angle_increment=ANGLES[1],
                         range_min=0.12, range_max=RANGE, ranges=ranges.tolist())
        scan.header.stamp, scan.header.frame_id = now, "base_scan"
        return scan

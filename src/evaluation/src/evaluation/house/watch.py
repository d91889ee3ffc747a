"""Observes the run through ROS: the robot's true and estimated poses, contacts, maps."""

from __future__ import annotations

import threading

import numpy as np
import rospy
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import PoseWithCovarianceStamped, Transform
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.msg import Path as PathMessage
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from evaluation.house.records import Records
from nav_algorithms.grid import OccupancyGrid
from nav_algorithms.poses import compose
from run_session import names
from run_session.asking import Asker
from run_session.simulator import place_of, pose_message, yaw_of
from trial_worlds.feelers import Feelers

ROBOT = "turtlebot3"  # its model name, as upstream's launch file spawns it
MAP, ODOM, BASE = "map", "odom", "base_footprint"
PLAN = "/move_base/NavfnROS/plan"
POSE_RATE_HZ = 25.0
TOLD_VARIANCES = {0: 0.25, 7: 0.25, 35: (np.pi / 12) ** 2}  # x, y, yaw of 36


class Watch:
    """Observes while others drive. Each part of the run gets new records.

    True poses are requested from the simulator 25 times a second; estimated ones come from /tf,
    one for each odometry transform. The node must exist before use_sim_time is set: then it needs
    no /clock, and is not disturbed when a restarted simulator's time begins again.
    """

    def __init__(self) -> None:
        rospy.init_node("navigate", anonymous=True, disable_signals=True, disable_rosout=True)
        self.records = Records()
        self.feelers: Feelers | None = None  # None: contacts are not recorded
        self.map: OccupancyGrid | None = None
        self.beams = np.empty(0)  # (N,), rad, of the laser
        self.hits: np.ndarray | None = None  # (N, 2), m, of the last scan, in the laser's frame
        self.plan = np.empty((0, 2))  # m, in the map's frame
        self._map_to_odom: np.ndarray | None = None
        self._ended = threading.Event()
        self._asker = Asker(self._ended)
        self._lock = threading.Lock()

    def start(self) -> None:
        """Begin to observe."""
        rospy.Subscriber("/tf", TFMessage, self._take_transforms, queue_size=100)
        rospy.Subscriber("/map", OccupancyGridMessage, self._take_map, queue_size=1)
        rospy.Subscriber("/scan", LaserScan, self._take_scan, queue_size=1)
        rospy.Subscriber(PLAN, PathMessage, self._take_plan, queue_size=1)
        threading.Thread(target=self._ask_poses, daemon=True, name="pose").start()

    def stop(self) -> None:
        """Stop observing; does not wait for an answer that may never come."""
        self._ended.set()

    def begin(self) -> None:
        """Begin a new part of the run: forget everything."""
        with self._lock:
            self.records = Records()
            self.map, self.hits, self._map_to_odom = None, None, None
            self.plan = np.empty((0, 2))

    def _ask_poses(self) -> None:
        for _ in self._asker.ticks(POSE_RATE_HZ, names.POSE, GetModelState):
            records = self.records
            reply = self._asker.call(ROBOT, "world")
            if reply is not None and reply.success:
                now, pose = reply.header.stamp.to_sec(), place_of(reply.pose)
                records.truth.append((now, *pose))
                if self.feelers is not None:
                    records.note_gap(self.feelers.gap(np.array(pose)), now)

    def _take_transforms(self, message: TFMessage) -> None:
        for each in message.transforms:
            link = each.header.frame_id.strip("/"), each.child_frame_id.strip("/")
            with self._lock:
                if link == (MAP, ODOM):
                    self._map_to_odom = _transform(each.transform)
                elif link == (ODOM, BASE) and self._map_to_odom is not None:
                    pose = compose(self._map_to_odom, _transform(each.transform))
                    self.records.believed.append((each.header.stamp.to_sec(), *pose.tolist()))

    def _take_map(self, message: OccupancyGridMessage) -> None:
        info = message.info
        cells = np.array(message.data, np.int8).reshape(info.height, info.width)
        place = info.origin.position
        self.map = OccupancyGrid(cells, info.resolution, (place.x, place.y))

    def _take_scan(self, message: LaserScan) -> None:
        angles = message.angle_min + message.angle_increment * np.arange(len(message.ranges))
        ranges = np.array(message.ranges)
        seen = (ranges >= message.range_min) & (ranges <= message.range_max)
        ways = np.stack((np.cos(angles[seen]), np.sin(angles[seen])), axis=1)
        self.hits, self.beams = ways * ranges[seen, None], angles

    def _take_plan(self, message: PathMessage) -> None:
        self.plan = np.array([(pose.pose.position.x, pose.pose.position.y)
                              for pose in message.poses]).reshape(-1, 2)


def told_pose(place: np.ndarray, now: float) -> PoseWithCovarianceStamped:
    """A message as from rviz's 2D Pose Estimate: x, y, yaw on the map, at a time, s."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id, message.header.stamp = MAP, rospy.Time.from_sec(now)
    message.pose.pose = pose_message(tuple(place.tolist()))
    message.pose.covariance = [TOLD_VARIANCES.get(k, 0.0) for k in range(36)]
    return message


def _transform(transform: Transform) -> np.ndarray:
    place = transform.translation
    return np.array([place.x, place.y, yaw_of(transform.rotation)])

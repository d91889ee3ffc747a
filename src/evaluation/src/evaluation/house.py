"""The simulated house: its file, and the observers of a robot that drives in it."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np
import rospy
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import PoseWithCovarianceStamped, Transform
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from nav_msgs.msg import Path as PathMessage
from node_basics.records import Length, Must, are, is_number, load_record
from sensor_msgs.msg import LaserScan
from terminal_language import heading
from tf2_msgs.msg import TFMessage

from evaluation.trajectory_error import at_moments
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.poses import compose, wrap_angle
from run_session import simulator
from run_session.failure import RunError
from run_session.files import find_package, located
from run_session.observer import poll
from run_session.session import StatusLine
from run_session.simulator import place_of, pose_message, yaw_of
from trial_worlds.feelers import Feelers, Gap
from trial_worlds.house import Ground


def _is_anywhere(value: object) -> bool:
    return is_number(value, -np.inf)


Pose = Annotated[tuple[float, float, float], Must(
    "[x, y, yaw]", lambda value: are(value, _is_anywhere, 3))]
Points = Annotated[tuple[tuple[float, float], ...], Must("a list of [x, y]", lambda value: bool(
    value) and are(value, lambda point: are(point, _is_anywhere, 2)))]


@dataclass(frozen=True)
class House:
    """A house file, key by key; m and rad, in the world's frame."""

    world: str  # path, or package://PACKAGE/PATH
    model: str  # TurtleBot3 model
    start: Pose
    laser_height: Length
    laser_reach: Length  # beyond it walls are not mapped
    passable: Length  # least distance from a wall to the robot's reference point
    max_speed: Length  # m/s
    goal_clearance: Length  # least distance from a wall to a random goal
    goal_distance: Length  # least distance from one random goal to the next
    way_points: Points  # of the mapping drive

    @property
    def world_path(self) -> Path:
        """Where the world file is."""
        return located(self.world).resolve()

    def ground(self) -> Ground:
        """Its true walls; WorldError if the file is not a world."""
        return Ground(self.world_path, self.start, self.laser_height, self.passable,
                      self.goal_clearance, self.goal_distance)


def load_house(name: str) -> House:
    """House `name` of houses/, or the file of that path; RunError names file and key."""
    return load_record(House, name, find_package("evaluation") / "houses", RunError)


TOUCHES = 0.005  # m; a smaller gap counts as contact, as poses are sampled at only 25 Hz
LONGEST_GAP = 0.2  # s, simulated, between two true poses, across which to interpolate
APART = 0.5  # s, simulated, after which a contact counts as a new one


@dataclass
class Contact:
    """The robot touched something for a while."""

    own: str  # the robot's collision element that touched first
    begin: float  # s, simulated
    end: float
    place: tuple[float, float]  # m, where it began, in the world


@dataclass
class Records:
    """Filled by callbacks in other threads; poses are (x, y, yaw), m and rad."""

    truth: list[tuple[float, float, float, float]] = field(default_factory=list)  # stamp, pose
    believed: list[tuple[float, float, float, float]] = field(default_factory=list)  # on the map
    contacts: list[Contact] = field(default_factory=list)
    nearest: tuple[float, float] = (np.inf, 0.0)  # smallest gap to anything, m, and when, s
    begun: float = 0.0  # s, simulated, from which on the robot may drive

    @property
    def now(self) -> float:
        """Simulated time, s, of the last true pose; 0 before the first."""
        return self.truth[-1][0] if self.truth else 0.0

    @property
    def true_pose(self) -> np.ndarray:
        """The last one (3,), in the world's frame."""
        return np.array(self.truth[-1][1:])

    @property
    def believed_pose(self) -> np.ndarray:
        """The last one (3,), in the map's frame."""
        return np.array(self.believed[-1][1:])

    @property
    def length(self) -> float:
        """Distance driven, m."""
        places = np.array(self.truth).reshape(-1, 4)[:, 1:3]
        return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())

    @property
    def longest_unseen(self) -> float:
        """The longest time, s, simulated, between two true poses since `begun`."""
        times = [row[0] for row in self.truth if row[0] >= self.begun]
        return max(np.diff(times), default=0.0)

    def show(self, progress: StatusLine, part: str, what: str) -> None:
        """Show the progress line of a part of the run, if one is due."""
        progress.update(self.now, lambda: (
            f"{heading(part)} {self.now:.1f} s | {what} | {self.length:.1f} m driven"
            f" | touched {len(self.contacts)} | real time x{progress.factor:.2f}"), part)

    def note_gap(self, gap: Gap, now: float) -> None:
        """Record the robot's gap to the nearest object at this time, s; small gaps are contacts."""
        self.nearest = min(self.nearest, (gap.width, now))
        if gap.width > TOUCHES:
            return
        if self.contacts and now - self.contacts[-1].end < APART:
            self.contacts[-1].end = now
        else:
            self.contacts.append(Contact(gap.own, now, now, gap.place))

    def errors(self, since: float, map_in_world: np.ndarray = np.zeros(3)
               ) -> tuple[np.ndarray, np.ndarray]:
        """Times (N,), s, and errors (N, 2), m and rad, of the estimated pose at those times."""
        times, believed, true = self.moments(since)
        there = compose(map_in_world, believed)
        return times, np.stack((np.linalg.norm(there[:, :2] - true[:, :2], axis=1),
                                np.abs(wrap_angle(there[:, 2] - true[:, 2]))), axis=1)

    def moments(self, since: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (N,), s, from `since` on, with estimated and true poses (N, 3).

        Leaves out gaps between true poses longer than LONGEST_GAP: the robot may have turned.
        """
        believed = np.array(self.believed[:]).reshape(-1, 4)
        truth = np.array(self.truth[:]).reshape(-1, 4)
        if not len(truth):
            return np.empty(0), np.empty((0, 3)), np.empty((0, 3))
        moments = believed[:, 0]
        true_poses = at_moments(truth[:, 0], truth[:, 1:], moments)
        after = np.searchsorted(truth[:, 0], moments).clip(1, max(len(truth) - 1, 1))
        unseen = np.diff(truth[:, 0], append=np.inf)[after - 1] > LONGEST_GAP
        known = np.isfinite(true_poses[:, 0]) & ~unseen & (moments >= since)
        return moments[known], believed[known, 1:], true_poses[known]


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
        records = self.records
        for reply in poll(self._ended, POSE_RATE_HZ, simulator.POSE, GetModelState, ROBOT, "world"):
            if reply.success:
                now, pose = reply.header.stamp.to_sec(), place_of(reply.pose)
                records.truth.append((now, *pose))
                if self.feelers is not None:
                    records.note_gap(self.feelers.gap(np.array(pose)), now)
            records = self.records  # before the next call: its answer may be older than new ones

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

"""What is written down while the racecar drives: where it is, where it thinks that it is, contacts.

Poses are (x, y, yaw), m and rad; times are simulated seconds.
"""

import math
import threading

import numpy as np
import rospy
import tf2_ros
from gazebo_msgs.msg import ContactsState
from nav_msgs.msg import Odometry, Path
from trial_venue import TOUCHED

from evaluation.trajectory_error import TrajectoryError, at_moments, trajectory_error
from nav_nodes.messages import pose_of, yaw_of

STANDING = 0.03  # m/s: slower is no driving, neither forwards nor backwards
PERIOD = 0.1     # s between two looks at what it thinks


class Record:
    """Of all that comes after this was made; rospy is initialised."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._truth: list[tuple[float, ...]] = []     # time, x, y, yaw, speed
        self._believed: list[tuple[float, ...]] = []  # time, x, y, yaw
        self.touched: list[tuple[float, str]] = []    # time, what touched a wall
        self.plans = 0  # of move_base
        self._transforms = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._transforms)
        self._subscribers = [
            rospy.Subscriber("/ground_truth", Odometry, self._take, tcp_nodelay=True),
            rospy.Subscriber(TOUCHED, ContactsState, self._take_contacts, tcp_nodelay=True),
            rospy.Subscriber("/move_base/HybridAStar/plan", Path, self._take_plan)]

    def _take(self, message: Odometry) -> None:
        stamp, velocity = message.header.stamp.to_sec(), message.twist.twist.linear
        x, y, yaw = pose_of(message.pose.pose)
        speed = velocity.x * math.cos(yaw) + velocity.y * math.sin(yaw)
        with self._lock:
            self._truth.append((stamp, x, y, yaw, speed))
        if not self._believed or stamp - self._believed[-1][0] >= PERIOD:
            self._believe()

    def _believe(self) -> None:
        try:
            found = self._transforms.lookup_transform("map", "base_link", rospy.Time(0))
        except tf2_ros.TransformException:
            return
        place, stamp = found.transform.translation, found.header.stamp.to_sec()
        with self._lock:
            if not self._believed or stamp > self._believed[-1][0]:
                self._believed.append((stamp, place.x, place.y, yaw_of(found.transform.rotation)))

    def _take_contacts(self, message: ContactsState) -> None:
        for state in message.states:
            if "racecar::" in state.collision2_name:
                self.touched.append((message.header.stamp.to_sec(), state.collision2_name))

    def _take_plan(self, _: Path) -> None:
        self.plans += 1

    @property
    def hears_contacts(self) -> bool:
        """Whether the simulator's contact sensor is there: silence of nobody would prove little."""
        return self._subscribers[1].get_num_connections() > 0

    @property
    def truth(self) -> np.ndarray:
        """(N, 5): time, x, y, yaw, speed forwards."""
        with self._lock:
            return np.array(self._truth).reshape(-1, 5)

    @property
    def believed(self) -> np.ndarray:
        """(N, 4): time, x, y, yaw on the map, as localisation has it."""
        with self._lock:
            return np.array(self._believed).reshape(-1, 4)


def localisation_error(truth: np.ndarray, believed: np.ndarray) -> TrajectoryError:
    """Of what was believed, at moments of which the truth is known; on a map in the truth's frame.

    Raises ValueError where there is no such moment.
    """
    places = at_moments(truth[:, 0], truth[:, 1:4], believed[:, 0])
    known = np.isfinite(places).all(axis=1)
    return trajectory_error(believed[known, 1:], places[known])


def way(truth: np.ndarray) -> float:
    """m driven, forwards and backwards together."""
    return float(np.hypot(*np.diff(truth[:, 1:3], axis=0).T).sum())


def turns_of_direction(truth: np.ndarray) -> int:
    """How often forwards became backwards, or the other way."""
    driven = truth[np.abs(truth[:, 4]) > STANDING, 4]
    return int((np.diff(np.sign(driven)) != 0).sum())

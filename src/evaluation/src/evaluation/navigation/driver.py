"""Sends the robot from goal to goal by move_base, and returns the result of each drive."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import actionlib
import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

from evaluation.house.watch import MAP, Watch, told_pose
from nav_algorithms.poses import compose, invert, wrap_angle
from run_session.simulator import pose_message
from trial_worlds.ground import Ground

LIMIT, LIMIT_FACTOR = 60.0, 5.0  # for a goal: s, simulated, plus a factor on the shortest time
CANCEL_LIMIT = 10.0  # s, simulated, for move_base to cancel a goal
TURN_RATE = 0.6  # rad/s
STANDING = 0.3  # s, simulated, at a goal before the pose is measured
DONE = (actionlib.CommState.DONE, actionlib.CommState.LOST)
TIME_IS_UP = "time is up"

Look = Callable[[str], None]  # waits a little, checks that everything still runs, shows progress


@dataclass(frozen=True)
class Way:
    """A drive to a goal; m, s simulated, rad; true values unless noted otherwise."""

    goal: tuple[float, float, float]  # in the world's frame
    reached: bool  # as reported by move_base
    text: str  # of move_base's result
    time: float
    driven: float
    straight: float  # straight-line distance
    shortest: float  # shortest collision-free path; inf: none
    off: float  # distance from the goal at the end
    off_yaw: float


class Driver:
    """Drives on a map; `map_in_world` (3,) is the pose of its frame in the world."""

    def __init__(self, watch: Watch, ground: Ground, look: Look, map_in_world: np.ndarray,
                 max_speed: float):
        self._watch, self._ground, self._look = watch, ground, look
        self._map_in_world, self._max_speed = map_in_world, max_speed
        self._client = actionlib.ActionClient("/move_base", MoveBaseAction)
        self._commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self._told = rospy.Publisher("/initialpose", PoseWithCovarianceStamped, queue_size=1)

    @property
    def is_connected(self) -> bool:
        """Whether move_base's action server is connected."""
        return self._client.wait_for_server(rospy.Duration(0.01))

    @property
    def is_heard(self) -> bool:
        """Whether there are subscribers to initial poses (localisation) and velocity commands."""
        return min(self._told.get_num_connections(), self._commands.get_num_connections()) > 0

    def drive_to(self, goal: np.ndarray, what: str) -> Way:
        """Send the goal (3,), in the world's frame; return when move_base is done or time is up."""
        records = self._watch.records
        start, began, before = records.true_pose, records.now, records.length
        shortest = self._ground.shortest_way(start, goal)
        until = began + LIMIT + LIMIT_FACTOR * min(shortest, 100.0) / self._max_speed
        sent = self._client.send_goal(self._goal(goal))
        text = None
        while sent.get_comm_state() not in DONE:
            left = np.linalg.norm(records.true_pose[:2] - goal[:2])
            self._look(f"{what}, {left:.1f} m off")
            if records.now > until and text is None:
                text, until = TIME_IS_UP, records.now + CANCEL_LIMIT
                sent.cancel()
            elif records.now > until:
                break
        took = records.now - began
        self._let_stand()
        reached = text is None and sent.get_goal_status() == GoalStatus.SUCCEEDED
        end = records.true_pose
        return Way(
            tuple(goal.tolist()), reached, text or sent.get_goal_status_text(),
            took, records.length - before,
            float(np.linalg.norm(goal[:2] - start[:2])), shortest,
            float(np.linalg.norm(end[:2] - goal[:2])), float(abs(wrap_angle(end[2] - goal[2]))))

    def tell_pose(self, pose: np.ndarray) -> None:
        """Publish an initial pose (3,), in the world's frame, as rviz's 2D Pose Estimate does."""
        on_map = compose(invert(self._map_in_world), pose)
        self._told.publish(told_pose(on_map, self._watch.records.now))

    def turn_round(self, what: str) -> None:
        """Turn once on the spot, timed by simulated time."""
        records = self._watch.records
        until = records.now + 2 * np.pi / TURN_RATE
        command = Twist()
        command.angular.z = TURN_RATE
        while records.now < until:
            self._commands.publish(command)
            self._look(what)
        self._commands.publish(Twist())

    def _let_stand(self) -> None:
        """Wait until the robot's resting pose has been observed."""
        until = self._watch.records.now + STANDING
        while self._watch.records.now < until:
            self._look("standing")

    def _goal(self, goal: np.ndarray) -> MoveBaseGoal:
        on_map = compose(invert(self._map_in_world), goal)
        message = MoveBaseGoal()
        message.target_pose.header.frame_id = MAP
        message.target_pose.header.stamp = rospy.Time.from_sec(self._watch.records.now)
        message.target_pose.pose = pose_message(tuple(on_map.tolist()))
        return message

"""Adapters for planners of other packages."""

from __future__ import annotations

import traceback
from collections.abc import Mapping
from functools import cache

import numpy as np
import rospy
from geometry_msgs.msg import Twist

from costmap_2d import CostmapROS
from move_base import exported
from move_base.global_planners import GLOBAL_PLANNERS, GlobalPlanner
from move_base.local_planners import LOCAL_PLANNERS, LocalPlanner, Situation
from move_base.plugin import chosen
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.velocities import Command
from nav_nodes.messages import pose_of, stamped_pose
from nav_nodes.parameters import Parameter

ODOMETRY = Parameter("odom_topic", "str", "odom", meaning="odometry with the robot's velocity")


class OwnGlobalPlanner(GlobalPlanner):
    """Wraps class OWN: initialize(name, costmap), make_plan(start, goal) -> [PoseStamped]."""

    OWN: type

    def __init__(self, costmap: CostmapROS) -> None:
        self._costmap, self._own = costmap, self.OWN()
        self._own.initialize(self.NAME, costmap)
        super().__init__(costmap)

    @property
    def entries(self) -> list[Parameter]:
        return []

    def change(self, values: dict) -> None:
        self.values = values

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        frame, now = self._costmap.global_frame, rospy.Time.now()
        plan = self._own.make_plan(*(stamped_pose(each, frame, now) for each in (start, goal)))
        return np.array([pose_of(each.pose) for each in plan]) if plan else None


class OwnLocalPlanner(LocalPlanner):
    """Wraps class OWN: initialize(name, tf, costmap), set_plan([PoseStamped]) -> bool,
    compute_velocity_commands() -> Twist or None, is_goal_reached() -> bool.
    """

    OWN: type

    def __init__(self, controller_frequency: float, costmaps: tuple[CostmapROS, CostmapROS]
                 ) -> None:
        self._fixed, local = costmaps
        self._own = self.OWN()
        self._own.initialize(self.NAME, local.transforms.buffer, local)
        super().__init__(controller_frequency, costmaps)

    @property
    def entries(self) -> list[Parameter]:
        return [ODOMETRY]

    def change(self, values: dict) -> None:
        self.values = values

    def set_path(self, path: np.ndarray, again: bool) -> None:
        frame, now = self._fixed.global_frame, rospy.Time.now()
        with self._lock:
            if not self._own.set_plan([stamped_pose(pose, frame, now) for pose in path]):
                raise ValueError(f"{self.NAME} does not take it")
            self._path = path

    def fastest(self) -> tuple[float, float]:
        """Unknown, so infinite."""
        return np.inf, np.inf

    def reached(self, situation: Situation) -> bool:
        return bool(self._own.is_goal_reached())

    def command(self, situation: Situation) -> Command | None:
        try:
            twist: Twist | None = self._own.compute_velocity_commands()
        except Exception:  # a learner's fault must not leave the robot with its last velocity
            rospy.logerr_throttle(5.0, f"{self.NAME} failed: {traceback.format_exc()}")
            return None
        if twist is None:
            return None
        command = Command(twist.linear.x, twist.linear.y, twist.angular.z, situation.pose[None])
        with self._lock:
            if not self._closed:
                self._publish(situation, command)
        return command


def global_planner(name: str, where: str) -> type[GlobalPlanner]:
    """A planner of ours or of any package. Raises ParameterError that lists the known ones."""
    return _kind(name, where, GLOBAL_PLANNERS, exported.GLOBAL)


def local_planner(name: str, where: str) -> type[LocalPlanner]:
    """As global_planner."""
    return _kind(name, where, LOCAL_PLANNERS, exported.LOCAL)


def _kind(name: str, where: str, ours: Mapping[str, type], base: str) -> type:
    if name in ours or name in {full.rpartition("/")[2] for full in ours}:
        return chosen(name, ours, where)
    found = exported.exported(base)
    return _placed(chosen(name, {**found, **ours}, where))


@cache
def _placed(entry: exported.Exported) -> type:
    """The adapter class, made once per entry, so that the same name gives the same class."""
    kind = OwnGlobalPlanner if entry.base == exported.GLOBAL else OwnLocalPlanner
    return type(entry.type.rpartition(".")[2], (kind,), {
        "NAME": entry.name.rpartition("/")[2], "OWN": exported.load(entry)})

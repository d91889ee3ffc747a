"""The available global planners, each with upstream's topics and parameters."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from typing import Any

import numpy as np
import rospy
from nav_msgs.msg import Path

from costmap_2d import CostmapROS
from move_base.plugin import Plugin, settings_from
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.global_planning import astar, carrot, hybrid_astar, navfn
from nav_nodes.messages import stamped_pose

# As upstream's planners say it.
START_OFF = ("The robot's start position is off the global costmap. Planning will always fail, are "
             "you sure the robot has been properly localized?")
GOAL_OFF = ("The goal sent to the global planner is off the global costmap. Planning will always "
            "fail to this goal.")
PERIOD = 10.0  # s between two of these lines


def path_message(path: np.ndarray, frame: str, stamp: rospy.Time) -> Path:
    """nav_msgs/Path of poses (N, 3)."""
    message = Path(poses=[stamped_pose(pose, frame, stamp) for pose in path])
    message.header.frame_id, message.header.stamp = frame, stamp
    return message


class GlobalPlanner(Plugin, ABC):
    """Subclasses set SETTINGS and plan in `_plan`."""

    SETTINGS: type
    PUBLISHES = True

    def __init__(self, costmap: CostmapROS) -> None:
        """`costmap`: the global one."""
        super().__init__()
        self._publishing = threading.Lock()  # another planner may replace it while it plans
        self._topic = (rospy.Publisher(f"~{self.NAME}/plan", Path, queue_size=1)
                       if self.PUBLISHES else None)

    def change(self, values: dict[str, Any]) -> None:
        super().change(values)
        self.settings = settings_from(self.SETTINGS, values)

    def close(self) -> None:
        super().close()
        with self._publishing:
            topic, self._topic = self._topic, None
            if topic is not None:
                topic.unregister()

    def plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
             goal: np.ndarray, frame: str) -> np.ndarray | None:
        """Path (N, 3) in the costmap's `frame`, or None; publishes it (None as an empty path)."""
        path = self._plan(costmap, footprint, start, goal)
        if path is None and not costmap.contains(costmap.cells_of(start[:2])):
            rospy.logwarn_throttle(PERIOD, START_OFF)
        if path is None and not costmap.contains(costmap.cells_of(goal[:2])):
            rospy.logwarn_throttle(PERIOD, GOAL_OFF)
        with self._publishing:
            if self._topic is not None and self._topic.get_num_connections():
                self._topic.publish(path_message(np.zeros((0, 3)) if path is None else path, frame,
                                                 rospy.Time.now()))
        return path

    @abstractmethod
    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        """Path (N, 3) in the costmap's frame, or None."""


class Navfn(GlobalPlanner):
    """navfn/NavfnROS."""

    NAME, TABLE, SETTINGS = "NavfnROS", "navfn", navfn.NavfnSettings

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        return navfn.plan(costmap, start, goal, settings=self.settings)


class Astar(GlobalPlanner):
    """global_planner/GlobalPlanner."""

    NAME, TABLE, SETTINGS = "GlobalPlanner", "global_planner", astar.GlobalPlannerSettings

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        return astar.plan(costmap, start, goal, settings=self.settings)


class Carrot(GlobalPlanner):
    """carrot_planner/CarrotPlanner, which publishes nothing."""

    NAME, TABLE, SETTINGS = "CarrotPlanner", "carrot_planner", carrot.CarrotSettings
    PUBLISHES = False

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        return carrot.plan(costmap, start, goal, footprint, self.settings)


class HybridAstar(GlobalPlanner):
    """car_planner/HybridAStar: paths that a car can drive."""

    NAME, TABLE, SETTINGS = "HybridAStar", "hybrid_astar", hybrid_astar.HybridAstarSettings

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        return hybrid_astar.plan(costmap, start, goal, footprint, self.settings)


GLOBAL_PLANNERS = {
    "navfn/NavfnROS": Navfn,
    "global_planner/GlobalPlanner": Astar,
    "carrot_planner/CarrotPlanner": Carrot,
    "car_planner/HybridAStar": HybridAstar,
}

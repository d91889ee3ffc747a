"""The available local planners, each with upstream's topics and parameters."""

from __future__ import annotations

import re
import threading
from dataclasses import dataclass
from typing import Any

import numpy as np
import rospy
from nav_msgs.msg import Path

from costmap_2d import CostmapROS
from move_base.global_planners import path_message
from move_base.plugin import Plugin, settings_from
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning import dwa, pure_pursuit, trajectory_rollout
from nav_algorithms.local_planning.velocities import Command
from nav_algorithms.poses import compose
from nav_nodes.parameters import ParameterError


@dataclass(frozen=True)
class Situation:
    """A local planner's input: poses (3,) in the costmap's `frame`, velocity in the base frame.

    `path_frame` is the pose of the frame in which the path was planned.
    """

    costmap: Costmap
    frame: str
    footprint: np.ndarray
    pose: np.ndarray
    velocity: np.ndarray
    path_frame: np.ndarray


class LocalPlanner(Plugin):
    """Subclasses set SETTINGS and PLANNER. All methods may be called on any thread."""

    SETTINGS: type
    PLANNER: type

    def __init__(self, controller_frequency: float, costmaps: tuple[CostmapROS, CostmapROS]
                 ) -> None:
        """`controller_frequency`: commands, Hz; `costmaps`: the global and the local one."""
        self._frequency = controller_frequency
        self._lock = threading.RLock()
        self._path: np.ndarray | None = None
        self._closed = False
        super().__init__()
        self._global_plan, self._local_plan = (
            rospy.Publisher(f"~{self.NAME}/{topic}", Path, queue_size=1)
            for topic in ("global_plan", "local_plan"))

    def change(self, values: dict[str, Any]) -> None:
        with self._lock:
            planner = self.PLANNER(self._settings(values))
            super().change(values)
            self._planner = planner
            if self._path is not None:
                self._planner.set_path(self._path)

    def _settings(self, values: dict[str, Any]) -> Any:
        """The algorithm's settings; raises ParameterError."""
        return settings_from(self.SETTINGS, values, controller_frequency=self._frequency)

    def at_frequency(self, controller_frequency: float) -> None:
        """Sets the rate of commands, Hz."""
        if controller_frequency != self._frequency:
            self._frequency = controller_frequency
            self.change(self.values)

    def close(self) -> None:
        super().close()
        with self._lock:
            self._closed = True
            self._global_plan.unregister()
            self._local_plan.unregister()

    def set_path(self, path: np.ndarray, again: bool) -> None:
        """Path (N, 3) to follow from now on. Raises ValueError if it is not a valid path.

        `again`: to the same goal as before.
        """
        with self._lock:
            self._planner.set_path(path, again)
            self._path = path

    def fastest(self) -> tuple[float, float]:
        """Greatest speed, m/s, and turn rate, rad/s."""
        with self._lock:
            return self._planner.limits().fastest

    def reached(self, situation: Situation) -> bool:
        """Whether the robot stands at the end of the path."""
        with self._lock:
            return self._planner.reached(situation.pose, situation.velocity, situation.path_frame)

    def command(self, situation: Situation) -> Command | None:
        """The next velocity; None if there is no valid one."""
        with self._lock:
            command = self._planner.command(situation.costmap, situation.footprint, situation.pose,
                                            situation.velocity, situation.path_frame)
            if not self._closed:  # another planner may replace it meanwhile
                self._publish(situation, command)
        return command

    def _publish(self, situation: Situation, command: Command | None) -> None:
        now = rospy.Time.now()
        if self._path is not None and self._global_plan.get_num_connections():
            ahead = compose(situation.path_frame, self._path)
            ahead = ahead[np.hypot(*(ahead[:, :2] - situation.pose[:2]).T).argmin():]
            cells = situation.costmap.cells_of(ahead[:, :2])
            outside = np.nonzero(~situation.costmap.contains(cells))[0]
            ahead = ahead[:outside[0]] if len(outside) else ahead
            self._global_plan.publish(path_message(ahead, situation.frame, now))
        if self._local_plan.get_num_connections():
            trajectory = np.zeros((0, 3)) if command is None else command.trajectory
            self._local_plan.publish(path_message(trajectory, situation.frame, now))


class Dwa(LocalPlanner):
    """dwa_local_planner/DWAPlannerROS."""

    NAME, TABLE = "DWAPlannerROS", "dwa_planner"
    SETTINGS, PLANNER = dwa.DwaSettings, dwa.DwaPlanner


class TrajectoryRollout(LocalPlanner):
    """base_local_planner/TrajectoryPlannerROS."""

    NAME, TABLE = "TrajectoryPlannerROS", "trajectory_planner"
    SETTINGS = trajectory_rollout.TrajectoryRolloutSettings
    PLANNER = trajectory_rollout.TrajectoryRollout

    def _settings(self, values: dict[str, Any]) -> Any:
        try:
            strafes = tuple(map(float, re.findall(r"[^][, ]+", values["y_vels"])))
        except ValueError:
            raise ParameterError(f"~{self.NAME}/y_vels is {values['y_vels']!r}, but must be "
                                 "numbers with commas between them") from None
        return super()._settings({**values, "y_vels": strafes})


class PurePursuit(LocalPlanner):
    """car_planner/PurePursuit: follows a path as planned, including backward parts."""

    NAME, TABLE = "PurePursuit", "pure_pursuit"
    SETTINGS, PLANNER = pure_pursuit.PurePursuitSettings, pure_pursuit.PurePursuit


LOCAL_PLANNERS = {
    "base_local_planner/TrajectoryPlannerROS": TrajectoryRollout,
    "dwa_local_planner/DWAPlannerROS": Dwa,
    "car_planner/PurePursuit": PurePursuit,
}

"""The control loop: drives to one goal after another, by the state machine."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import RecoveryStatus

from costmap_2d import CostmapROS
from move_base.base import Base
from move_base.local_planners import LocalPlanner, Situation
from move_base.planning import Planning
from move_base.recoveries import Recovery, RecoveryContext
from move_base.state_machine import GOAL_REACHED, State, StateMachine
from move_base.watch import Watch
from nav_algorithms.local_planning.following import Following
from nav_algorithms.poses import wrap_angle
from nav_nodes.messages import stamped_pose
from nav_nodes.transforms import Transforms

NEARER = 0.05   # m along the path
TURNED = 0.3    # rad, towards the goal's yaw
BESIDE = 0.3    # m of path left, below which turning counts
DETOUR = 0.25   # m by which the path became longer: an obstacle was seen, which is no failure
NOT_PASSED = "Failed to pass global plan to the controller."


class Progress:
    """Whether the robot gets nearer to one goal, rather than just turning back and forth.

    For `progress_timeout`. Upstream counts every velocity as success, so with oscillation_timeout 0
    a robot that cannot quite reach its goal stays in front of it for ever. Poses (3,) and paths
    (N, 3) are in one fixed frame.
    """

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Begin a new goal."""
        self._following: Following | None = None
        self._way = self._turn = math.inf

    def take(self, path: np.ndarray) -> None:
        """The path that is followed from now on. Raises ValueError if it is not a valid path."""
        self._following = Following(path)

    def is_nearer(self, pose: np.ndarray) -> bool:
        """Whether the robot is nearer than when this was last true; there must be a path."""
        following = self._following
        left = following.left(pose)
        way = float(following.lengths[-1] - following.lengths[following.at]
                    + np.hypot(*(left[0, :2] - pose[:2])))
        turn = abs(wrap_angle(left[-1, 2] - pose[2])) if way < BESIDE else math.inf
        if way > self._way + DETOUR:
            self._way, self._turn = way, math.inf
            return False
        if way < self._way - NEARER or turn < self._turn - TURNED:
            self._way, self._turn = min(way, self._way), min(turn, self._turn)
            return True
        return False


@dataclass(frozen=True)
class Outcome:
    """How a goal ended, with the action's terminal text."""

    succeeded: bool
    text: str


class Navigator:
    """Executes the cycles of the control loop. Called by the action's thread."""

    def __init__(self, costmaps: tuple[CostmapROS, CostmapROS], transforms: Transforms,
                 base: Base, watch: Watch, machine: StateMachine, planning: Planning,
                 local_planner: LocalPlanner, recoveries: list[Recovery]) -> None:
        """`costmaps`: the global and the local one. The local planner may be replaced later."""
        self._costmaps, self._transforms, self._base = costmaps, transforms, base
        self._watch, self._machine, self._planning = watch, machine, planning
        self.local_planner, self._recoveries = local_planner, recoveries
        self._recovering: Recovery | None = None
        self._has_path = False  # to the current goal
        self._progress = Progress()
        self._status = rospy.Publisher("~recovery_status", RecoveryStatus, queue_size=1)

    def begin(self, goal: PoseStamped) -> None:
        """Begin a goal, which may replace another."""
        self._base.stop()
        self._recovering, self._has_path = None, False
        self._progress.begin()
        self._planning.begin(self._machine.begin(rospy.get_time()), goal)

    def end(self) -> None:
        """Stop the robot and the planning."""
        self._machine.end()
        self._recovering = None
        self._base.stop()

    def cycle(self, now: float, values: dict[str, Any]
              ) -> tuple[PoseStamped | None, Outcome | None]:
        """One cycle at `now`, s; returns the robot's pose and the goal's outcome, or None for each.

        While data is missing the robot stands and patience timers are held. `values`: move_base's
        parameters.
        """
        self._base.expect(*self.local_planner.fastest(), values["odometry_factor"])
        pose = self._costmaps[0].robot_pose()
        if not self._watch.can_drive(now, values["data_timeout"],
                                     values["map_required"]) or pose is None:
            self._base.stop()
            self._machine.hold(now)
            return None, None
        where = stamped_pose(pose, self._costmaps[0].global_frame, rospy.Time.now())
        self._machine.at(pose[0], pose[1], now)
        state = self._machine.state
        if state is State.CLEARING:
            return where, self._recover(where, values["controller_frequency"])
        return where, self._control(now, pose) if state is State.CONTROLLING else None

    def _control(self, now: float, pose: np.ndarray) -> Outcome | None:
        path = self._planning.take_path()
        if path is not None:
            try:
                self.local_planner.set_path(path, self._has_path)
                self._progress.take(path)
            except ValueError as error:
                rospy.logerr("Failed to pass global plan to the controller, aborting: %s", error)
                return Outcome(False, NOT_PASSED)
            self._has_path = True
            self._machine.took_path()
        situation = self._situation()
        if situation is None:
            self._base.stop()
            return None
        if self.local_planner.reached(situation):
            return Outcome(True, GOAL_REACHED)
        if self._machine.oscillates(now):
            self._base.stop()
            return None
        command = self.local_planner.command(situation)
        if command is None:
            self._base.stop()
        else:
            self._base.drive(command.velocity)
        self._machine.controlled(command is not None, self._progress.is_nearer(pose),
                                 rospy.get_time())
        return None

    def _situation(self) -> Situation | None:
        """The situation in the local costmap's frame; None if the path's frame is unknown."""
        fixed, local = self._costmaps
        pose = local.robot_pose()
        path_frame = (np.zeros(3) if fixed.global_frame == local.global_frame
                      else self._transforms.pose(local.global_frame, fixed.global_frame))
        if pose is None or path_frame is None:
            return None
        return Situation(local.snapshot(), local.global_frame, local.footprint, pose,
                         self._base.velocity, path_frame)

    def _recover(self, where: PoseStamped, frequency: float) -> Outcome | None:
        failure = self._machine.failure()
        if failure is not None:
            rospy.logerr("Aborting: %s", failure)
            return Outcome(False, failure)
        if self._recovering is None:
            number = self._machine.recovery
            self._recovering = self._recoveries[number]
            self._base.stop()
            self._status.publish(RecoveryStatus(where, number, len(self._recoveries),
                                                self._recovering.name))
            self._recovering.start(RecoveryContext(*self._costmaps, self._base, frequency))
        if self._recovering.step():
            self._recovering = None
            self._machine.recovered(rospy.get_time())
        return None

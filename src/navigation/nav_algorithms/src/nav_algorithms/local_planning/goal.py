"""The end of a path: stop at the goal, turn on the spot to its yaw, and report when it is done."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.velocities import Command, slowed, turning
from nav_algorithms.poses import wrap_angle

TURN_STEP = 0.05  # rad, between two collision checks of the turning footprint


@dataclass(frozen=True)
class Arrival:
    """The conditions of arrival, and how the robot turns. SI units; one command per period."""

    xy_goal_tolerance: float
    yaw_goal_tolerance: float
    latch_xy_goal_tolerance: bool
    trans_stopped_vel: float
    theta_stopped_vel: float
    min_turn: float      # rad/s, the slowest turn on the spot
    max_turn: float      # rad/s
    acceleration: tuple[float, float, float]
    period: float        # s


class StopAndTurn:
    """Takes over once the robot is within reach of the goal; if latched, keeps it until reset.

    As base_local_planner's LatchedStopRotateController, but only checks the turn that is needed,
    and turns the other way round if the short one is blocked.
    """

    def __init__(self, arrival: Arrival) -> None:
        self.arrival = arrival
        self.reset()

    def reset(self) -> None:
        """For a new path: nothing is latched."""
        self.latched = self.turning = False

    def at_place(self, pose: np.ndarray, goal: np.ndarray) -> bool:
        """Whether the position is right, or was before, with latching."""
        near = np.hypot(*(goal[:2] - pose[:2])) <= self.arrival.xy_goal_tolerance
        self.latched = self.latched or near
        return bool(near or (self.arrival.latch_xy_goal_tolerance and self.latched))

    def reached(self, pose: np.ndarray, velocity: np.ndarray, goal: np.ndarray) -> bool:
        """Whether position and yaw are right and the robot stands."""
        return (self.at_place(pose, goal)
                and abs(wrap_angle(goal[2] - pose[2])) <= self.arrival.yaw_goal_tolerance
                and self._stands(velocity))

    def _stands(self, velocity: np.ndarray) -> bool:
        return bool(np.hypot(*velocity[:2]) <= self.arrival.trans_stopped_vel
                    and abs(velocity[2]) <= self.arrival.theta_stopped_vel)

    def command(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
                velocity: np.ndarray, goal: np.ndarray) -> Command | None:
        """The command at the right position: stop, then turn. None if no turn is free."""
        arrival = self.arrival
        standing = np.array([pose])
        angle = wrap_angle(goal[2] - pose[2])
        if abs(angle) <= arrival.yaw_goal_tolerance:
            self.turning = False
            return Command(0.0, 0.0, 0.0, standing)
        if not self.turning and not self._stands(velocity):
            vx, vy, omega = slowed(velocity, arrival.acceleration, arrival.period)
            return Command(float(vx), float(vy), float(omega), standing)
        self.turning = True
        for turn in (angle, angle - np.sign(angle) * 2 * np.pi):
            poses = turned(pose, turn)
            if (footprints.costs(costmap, footprint, poses) >= 0).all():
                omega = turning(turn, velocity[2], arrival.min_turn, arrival.max_turn,
                                arrival.acceleration[2], arrival.period)
                return Command(0.0, 0.0, omega, poses)
        return None


def turned(pose: np.ndarray, angle: float, step: float = TURN_STEP) -> np.ndarray:
    """Poses (M, 3) of a turn on the spot by `angle`, rad, beginning with the current one."""
    steps = max(int(np.ceil(abs(angle) / step)), 1)
    poses = np.repeat(np.asarray(pose, float)[None], steps + 1, axis=0)
    poses[:, 2] += np.linspace(0.0, angle, steps + 1)
    return poses

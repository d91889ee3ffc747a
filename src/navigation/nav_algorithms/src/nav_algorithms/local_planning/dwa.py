"""DWAPlannerROS: of the reachable velocities, the one whose trajectory costs the least.

D. Fox, W. Burgard, S. Thrun, "The dynamic window approach to collision avoidance" (1997), with the
costs and parameter names of dwa_local_planner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.costmap.footprint import Ground
from nav_algorithms.local_planning import rollout
from nav_algorithms.local_planning.goal import Arrival
from nav_algorithms.local_planning.local_planner import LocalPlanner, Oscillation, distances_to
from nav_algorithms.local_planning.velocities import (
    Command,
    Limits,
    all_samples,
    window,
)

EPSILON = 1e-4


@dataclass(frozen=True)
class DwaSettings:
    """Parameters of dwa_local_planner/DWAPlannerROS; m, s, rad.

    A negative velocity limit means none. `acc_lim_trans` and `prune_plan` have no effect: each axis
    has its own limit, and the path behind the robot is always left out. A turn on the spot is
    scored where it is best, not at the end of `sim_time`: upstream's robots turn past their path.
    """

    acc_lim_x: float
    acc_lim_y: float
    acc_lim_theta: float
    acc_lim_trans: float
    max_vel_trans: float
    min_vel_trans: float
    max_vel_x: float
    min_vel_x: float
    max_vel_y: float
    min_vel_y: float
    max_vel_theta: float
    min_vel_theta: float
    xy_goal_tolerance: float
    yaw_goal_tolerance: float
    latch_xy_goal_tolerance: bool
    sim_time: float
    sim_granularity: float
    angular_sim_granularity: float
    vx_samples: int
    vy_samples: int
    vth_samples: int
    path_distance_bias: float
    goal_distance_bias: float
    occdist_scale: float
    twirling_scale: float
    forward_point_distance: float
    stop_time_buffer: float
    scaling_speed: float
    max_scaling_factor: float
    oscillation_reset_dist: float
    oscillation_reset_angle: float
    prune_plan: bool
    trans_stopped_vel: float
    theta_stopped_vel: float
    use_dwa: bool
    controller_frequency: float  # move_base's: one command per period


class DwaPlanner(LocalPlanner):
    """The dynamic window approach."""

    def __init__(self, settings: DwaSettings) -> None:
        self.settings = settings
        super().__init__(Arrival(
            settings.xy_goal_tolerance, settings.yaw_goal_tolerance,
            settings.latch_xy_goal_tolerance, settings.trans_stopped_vel,
            settings.theta_stopped_vel, settings.min_vel_theta, settings.max_vel_theta,
            (settings.acc_lim_x, settings.acc_lim_y, settings.acc_lim_theta),
            1.0 / settings.controller_frequency),
            Oscillation(settings.oscillation_reset_dist, settings.oscillation_reset_angle))

    def limits(self) -> Limits:
        s = self.settings
        return Limits((s.min_vel_x, s.min_vel_y, -s.max_vel_theta),
                      (s.max_vel_x, s.max_vel_y, s.max_vel_theta),
                      s.max_vel_trans if s.max_vel_trans >= 0.0 else np.inf)

    def _best(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              velocity: np.ndarray, near: np.ndarray, goal: np.ndarray) -> Command | None:
        """The cheapest of the samples without a collision."""
        s = self.settings
        samples = self.samples(velocity, float(np.hypot(*(goal[:2] - pose[:2]))))
        samples = samples[self.oscillation.allowed(samples)]
        if not len(samples):
            return None
        ground = Ground.of(costmap, footprints.free_radii(costmap), footprint)
        scoring = rollout.Scoring(
            self._grids(costmap, near, pose), self._weights(costmap, pose, near),
            float(s.forward_point_distance), float(np.hypot(*(goal[:2] - pose[:2]))))
        growth = rollout.Growth(float(s.scaling_speed), float(s.max_scaling_factor),
                                float(s.max_vel_trans))
        found = rollout.rollouts(ground, self._motion(), scoring, growth, samples, pose, velocity)
        cost = np.where(found[:, rollout.LEGAL] > 0.0, found[:, rollout.DISTANCE]
                        + s.occdist_scale * found[:, rollout.OCCUPANCY]
                        + s.twirling_scale * np.abs(samples[:, 2]), np.inf)
        best = int(cost.argmin())
        if not np.isfinite(cost[best]):
            return None
        self.oscillation.took(samples[best], pose, s.min_vel_trans)
        vx, vy, omega = map(float, samples[best])
        return Command(vx, vy, omega,
                       rollout.trajectory(pose, velocity, samples[best], self._motion()))

    def _motion(self) -> rollout.Motion:
        s = self.settings
        return rollout.Motion(self._accelerations(), s.use_dwa, float(s.sim_time),
                              float(s.sim_granularity), float(s.angular_sim_granularity),
                              float(s.stop_time_buffer))

    def _accelerations(self) -> np.ndarray:
        s = self.settings
        return np.array([s.acc_lim_x, s.acc_lim_y, s.acc_lim_theta], float)

    def samples(self, velocity: np.ndarray, to_goal: float) -> np.ndarray:
        """Velocities (S, 3) to try, for a robot with `velocity`, `to_goal`, m, from its goal.

        With `use_dwa` those of the next period; else those within `sim_time`, none of which passes
        the goal. None is slower than both `min_vel_trans` and `min_vel_theta`.
        """
        s = self.settings
        high = np.array([s.max_vel_x, s.max_vel_y, s.max_vel_theta])
        low = np.array([s.min_vel_x, s.min_vel_y, -s.max_vel_theta])
        if not s.use_dwa:
            high[0] = max(min(high[0], to_goal / s.sim_time), low[0])
        duration = 1.0 / s.controller_frequency if s.use_dwa else s.sim_time
        low, high = window(velocity, low, high, self._accelerations(), duration,
                           np.array([s.min_vel_trans, 0.0, s.min_vel_theta]))
        samples = all_samples(low, high, (s.vx_samples, s.vy_samples, s.vth_samples))
        speeds, turns = np.hypot(samples[:, 0], samples[:, 1]), np.abs(samples[:, 2])
        keep = (speeds + EPSILON >= s.min_vel_trans) | (turns + EPSILON >= s.min_vel_theta)
        if s.max_vel_trans >= 0.0:
            keep &= speeds - EPSILON <= s.max_vel_trans
        return np.ascontiguousarray(samples[keep])

    def _grids(self, costmap: Costmap, near: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Distances (3, rows, columns) to the path, to its end, and to a point ahead of its end."""
        end = near[-1, :2]
        bearing = np.arctan2(*(end - pose[:2])[::-1])
        front = end + self.settings.forward_point_distance * np.array([np.cos(bearing),
                                                                       np.sin(bearing)])
        return np.stack([distances_to(costmap, near[:, :2], near[:, :2]),
                         distances_to(costmap, end[None], near[:, :2]),
                         distances_to(costmap, front[None], np.vstack((near[:, :2], front)))])

    def _weights(self, costmap: Costmap, pose: np.ndarray, near: np.ndarray) -> np.ndarray:
        """Weights of the distances to the path, the goal and the goal's front, and of ALIGNMENT.

        Close to the end of the path the robot need not face along it any more; and the nearer the
        goal, the less it should face it, or it would oscillate in front of it.
        """
        path = self.settings.path_distance_bias * costmap.resolution
        goal = self.settings.goal_distance_bias * costmap.resolution
        forward = max(self.settings.forward_point_distance, 1e-6)
        left = float(np.hypot(*(near[-1, :2] - pose[:2])))
        return np.array([path, goal, goal * min(left / forward, 1.0),
                         path if left > forward else 0.0])

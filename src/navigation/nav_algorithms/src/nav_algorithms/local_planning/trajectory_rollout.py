"""TrajectoryPlannerROS: forwards if that helps, else turn on the spot, else strafe, else back out.

B. Gerkey and K. Konolige, "Planning and control in unstructured terrain" (2008), with the scores
and parameter names of base_local_planner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.costmap.footprint import Ground
from nav_algorithms.local_planning import rollout
from nav_algorithms.local_planning.goal import Arrival
from nav_algorithms.local_planning.local_planner import LocalPlanner, Oscillation, distances_to
from nav_algorithms.local_planning.velocities import (
    Command,
    Limits,
    all_samples,
    samples,
    window,
)
from nav_algorithms.poses import wrap_angle

HEADING_SCALE = 0.3  # upstream's, per radian off the heading
NO_GROWTH = rollout.Growth(np.inf, 0.0, 0.0)


@dataclass(frozen=True)
class TrajectoryRolloutSettings:
    """Parameters of base_local_planner/TrajectoryPlannerROS; m, s, rad.

    `prune_plan` has no effect: the path behind the robot is always left out. Upstream backs out
    (`escape_vel`) even into obstacles; here it only does if that is free.
    """

    acc_lim_x: float
    acc_lim_y: float
    acc_lim_theta: float
    max_vel_x: float
    min_vel_x: float
    max_vel_theta: float
    min_vel_theta: float
    min_in_place_vel_theta: float
    escape_vel: float
    holonomic_robot: bool
    y_vels: tuple[float, ...]
    xy_goal_tolerance: float
    yaw_goal_tolerance: float
    latch_xy_goal_tolerance: bool
    prune_plan: bool
    sim_time: float
    sim_granularity: float
    angular_sim_granularity: float
    vx_samples: int
    vtheta_samples: int
    meter_scoring: bool
    pdist_scale: float
    gdist_scale: float
    occdist_scale: float
    simple_attractor: bool
    heading_lookahead: float
    heading_scoring: bool
    heading_scoring_timestep: float
    dwa: bool
    oscillation_reset_dist: float
    escape_reset_dist: float
    escape_reset_theta: float
    trans_stopped_velocity: float
    rot_stopped_velocity: float
    controller_frequency: float  # move_base's: one command per period


class TrajectoryRollout(LocalPlanner):
    """Trajectory rollout; with `dwa` its samples are those of the next period."""

    def __init__(self, settings: TrajectoryRolloutSettings) -> None:
        s = self.settings = settings
        super().__init__(Arrival(
            s.xy_goal_tolerance, s.yaw_goal_tolerance, s.latch_xy_goal_tolerance,
            s.trans_stopped_velocity, s.rot_stopped_velocity, s.min_in_place_vel_theta,
            s.max_vel_theta, (s.acc_lim_x, s.acc_lim_y, s.acc_lim_theta),
            1.0 / s.controller_frequency), Oscillation(s.oscillation_reset_dist, np.inf))
        self.escaped_from: np.ndarray | None = None

    def limits(self) -> Limits:
        s = self.settings
        strafe = max(map(abs, s.y_vels), default=0.0) if s.holonomic_robot else 0.0
        in_place = min(s.min_in_place_vel_theta, s.max_vel_theta)  # at the goal, both ways
        return Limits((min(s.escape_vel, s.min_vel_x), -strafe, min(s.min_vel_theta, -in_place)),
                      (max(s.max_vel_x, s.min_vel_x), strafe, s.max_vel_theta))

    def _best(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              velocity: np.ndarray, near: np.ndarray, goal: np.ndarray) -> Command | None:
        scorer = _Scorer(self.settings, costmap, footprint, pose, velocity, near)
        if self._escaping(pose):
            taken = scorer.first_free([[self.settings.escape_vel, 0.0, 0.0]])
            if taken is not None:
                return scorer.command(taken)
            self.escaped_from = None
        taken = self._forwards_or_turning(scorer, velocity, float(np.hypot(*(goal - pose)[:2])))
        if taken is None and self.settings.holonomic_robot:
            strafes = [[0.0, y, 0.0] for y in self.settings.y_vels]
            taken = scorer.nearest_ahead(self._allowed(strafes), np.inf)
        if taken is None:
            taken = scorer.first_free([[self.settings.escape_vel, 0.0, 0.0]])
            if taken is None:
                return None
            self.escaped_from = pose
            return scorer.command(taken)
        self.oscillation.took(taken, pose, self.settings.min_vel_x)
        return scorer.command(taken)

    def _escaping(self, pose: np.ndarray) -> bool:
        """Whether the robot is still backing out of where nothing else was free."""
        if self.escaped_from is None:
            return False
        moved = np.hypot(*(pose[:2] - self.escaped_from[:2]))
        turned = abs(wrap_angle(pose[2] - self.escaped_from[2]))
        if moved > self.settings.escape_reset_dist or turned > self.settings.escape_reset_theta:
            self.escaped_from = None
        return self.escaped_from is not None

    def _allowed(self, candidates: np.ndarray) -> np.ndarray:
        candidates = np.array(candidates, float).reshape(-1, 3)
        return candidates[self.oscillation.allowed(candidates)]

    def _forwards_or_turning(self, scorer: _Scorer, velocity: np.ndarray, to_goal: float
                             ) -> np.ndarray | None:
        """The cheapest drive; or a turn on the spot instead, if that costs no more."""
        s = self.settings
        high = np.array([max(min(s.max_vel_x, to_goal / s.sim_time), s.min_vel_x), 0.0,
                         s.max_vel_theta])
        low = np.array([s.min_vel_x, 0.0, s.min_vel_theta])
        duration = 1.0 / s.controller_frequency if s.dwa else s.sim_time
        # The slowest speed and turn are possible from standstill at once, see `window`.
        low, high = window(velocity, low, high, np.array([s.acc_lim_x, 0.0, s.acc_lim_theta]),
                           duration, np.array([s.min_vel_x, 0.0, s.min_in_place_vel_theta]))
        drives = all_samples(low, high, (s.vx_samples, 1, s.vtheta_samples))
        drives, cost = scorer.costs(self._allowed(drives[drives[:, 0] > 1e-6]))
        best = None
        limit = np.inf
        if len(drives) and np.isfinite(cost.min()):
            best, limit = drives[cost.argmin()], float(cost.min())
        turns = samples(low[2], high[2], s.vtheta_samples)
        turns = np.sign(turns) * np.maximum(np.abs(turns), s.min_in_place_vel_theta)
        turns = np.unique(np.clip(turns[turns != 0.0], s.min_vel_theta, s.max_vel_theta))
        turns = self._allowed(np.stack((0 * turns, 0 * turns, turns), axis=1))
        turn = scorer.nearest_ahead(turns, limit)
        return best if turn is None else turn


class _Scorer:
    """Scores samples that begin at this pose, on this costmap."""

    def __init__(self, settings: TrajectoryRolloutSettings, costmap: Costmap,
                 footprint: np.ndarray, pose: np.ndarray, velocity: np.ndarray, near: np.ndarray
                 ) -> None:
        self.settings, self.costmap, self.footprint = settings, costmap, footprint
        self.pose, self.velocity, self.near = pose, velocity, near
        if settings.simple_attractor:
            path, goal = np.zeros(costmap.cells.shape), _square_distances(costmap, near[-1, :2])
        else:
            path = distances_to(costmap, near[:, :2], near[:, :2])
            goal = distances_to(costmap, near[-1:, :2], near[:, :2])
        self.grids = np.stack((path, goal, goal))
        self.ground = Ground.of(costmap, footprints.free_radii(costmap), footprint)
        unit = costmap.resolution if settings.meter_scoring else 1.0
        self.scales = np.array([settings.pdist_scale, settings.gdist_scale, 0.0, 0.0]) * unit
        self.motion = rollout.Motion(
            np.array([settings.acc_lim_x, settings.acc_lim_y, settings.acc_lim_theta], float),
            False, float(settings.sim_time), float(settings.sim_granularity),
            float(settings.angular_sim_granularity), 0.0)

    def _rolled(self, candidates: np.ndarray, weights: np.ndarray) -> np.ndarray:
        s = self.settings
        ahead = float(np.hypot(*(self.near[-1, :2] - self.pose[:2])))
        scoring = rollout.Scoring(self.grids, weights, float(s.heading_lookahead), ahead)
        return rollout.rollouts(self.ground, self.motion, scoring, NO_GROWTH,
                                np.ascontiguousarray(candidates, float).reshape(-1, 3), self.pose,
                                self.velocity)

    def costs(self, candidates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The candidates (S, 3) and their costs (S,), inf if they collide."""
        found = self._rolled(candidates, self.scales)
        cost = (found[:, rollout.DISTANCE]
                + self.settings.occdist_scale * found[:, rollout.WORST])
        if self.settings.heading_scoring and len(candidates):
            cost = cost + HEADING_SCALE * self._off_heading(candidates)
        return candidates, np.where(found[:, rollout.LEGAL] > 0.0, cost, np.inf)

    def nearest_ahead(self, candidates: np.ndarray, limit: float) -> np.ndarray | None:
        """Of those that cost at most `limit`, the one that faces the point nearest to the goal."""
        found = self._rolled(candidates, self.scales + np.array([0.0, 0.0, 1e-3, 0.0]))
        cost = (found[:, rollout.PATH:rollout.GOAL + 1] @ self.scales[:2]
                + self.settings.occdist_scale * found[:, rollout.WORST])
        fit = (found[:, rollout.LEGAL] > 0.0) & (cost <= limit)
        if not fit.any():
            return None
        return candidates[np.where(fit, found[:, rollout.FRONT], np.inf).argmin()]

    def first_free(self, candidates: np.ndarray) -> np.ndarray | None:
        """The first that does not collide, wherever it leads."""
        for candidate in np.array(candidates, float):
            if (footprints.costs(self.costmap, self.footprint, self._driven(candidate)) >= 0).all():
                return candidate
        return None

    def _off_heading(self, candidates: np.ndarray) -> np.ndarray:
        """Angle (S,), rad, between the heading after a while and the path's farthest free point."""
        after = self.settings.heading_scoring_timestep
        target = self.near[-1, :2]
        for point in self.near[::-max(len(self.near) // 20, 1), :2]:
            share = np.linspace(0.0, 1.0, 40)[:, None]
            cells = self.costmap.cells_of(self.pose[:2] + share * (point - self.pose[:2]))
            if (self.costmap.cells[tuple(cells.T)] < LETHAL).all():
                target = point
                break
        middle = self.pose[2] + 0.5 * after * candidates[:, 2]
        place = self.pose[:2] + after * candidates[:, :1] * np.stack(
            (np.cos(middle), np.sin(middle)), axis=1)
        bearing = np.arctan2(*(target - place).T[::-1])
        return np.abs(wrap_angle(self.pose[2] + after * candidates[:, 2] - bearing))

    def _driven(self, candidate: np.ndarray) -> np.ndarray:
        return rollout.trajectory(self.pose, self.velocity, np.ascontiguousarray(candidate, float),
                                  self.motion)

    def command(self, candidate: np.ndarray) -> Command:
        """The candidate with its trajectory."""
        return Command(*map(float, candidate), self._driven(candidate))


def _square_distances(costmap: Costmap, place: np.ndarray) -> np.ndarray:
    """Squared distance of each cell's centre from a point (2,), m^2, as upstream's attractor."""
    rows, columns = np.indices(costmap.cells.shape)
    middles = (np.stack((columns, rows), axis=-1) + 0.5) * costmap.resolution + costmap.origin
    return ((middles - place)**2).sum(axis=-1)

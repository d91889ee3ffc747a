"""Regulated pure pursuit, for cars: follows the path as planned, including backwards.

The path is cut where the vehicle changes its kind of motion.

R. Coulter, "Implementation of the pure pursuit path tracking algorithm" (1992); S. Macenski et al.,
"Regulated pure pursuit for robot path tracking" (2023), whose parameters have these names.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.following import STANDSTILL
from nav_algorithms.local_planning.free_arcs import free_arc, space
from nav_algorithms.local_planning.goal import turned
from nav_algorithms.local_planning.velocities import Command, Limits, turning
from nav_algorithms.poses import compose, relative, wrap_angle

FORWARD, BACKWARD, ON_THE_SPOT = 1, -1, 0
AHEAD = 1.0       # m along the path that are searched for the vehicle's position
DONE = 0.02       # m before its end where a piece is finished
ENOUGH = 0.15     # m before its end where it is finished if something is in the way
STEERED = 0.3     # of the maximum curvature: wheels that are farther off are still being steered
STEERING_TIME = 0.6  # s, for which a piece may begin slowly because of that


@dataclass(frozen=True)
class Piece:
    """Poses (M, 3), M >= 2, driven FORWARD or BACKWARD, or turned ON_THE_SPOT.

    `lengths` (M,): m driven from the first pose to each; on the spot, rad turned.
    """

    poses: np.ndarray
    direction: int
    lengths: np.ndarray


def cut(path: np.ndarray) -> list[Piece]:
    """The pieces of a path (N, 3); empty if nothing moves.

    A step is driven backwards if the next pose is behind, seen along the mean of both headings,
    and is a turn if only the heading changes.
    """
    path = np.asarray(path, float)
    steps = np.diff(path[:, :2], axis=0)
    turns = wrap_angle(np.diff(path[:, 2]))
    middle = path[:-1, 2] + 0.5 * turns
    ahead = steps[:, 0] * np.cos(middle) + steps[:, 1] * np.sin(middle)
    sizes = np.hypot(*steps.T)
    kinds = np.where(sizes > 1e-6, np.where(ahead >= 0.0, FORWARD, BACKWARD), ON_THE_SPOT)
    moves = np.nonzero((sizes > 1e-6) | (np.abs(turns) > 1e-6))[0]
    found: list[Piece] = []
    begin = 0
    for n in range(1, len(moves) + 1):
        if n == len(moves) or kinds[moves[n]] != kinds[moves[begin]]:
            kind = int(kinds[moves[begin]])
            chosen = moves[begin:n]
            poses = np.vstack((path[chosen[0]], path[chosen + 1]))
            size = np.abs(turns[chosen]) if kind == ON_THE_SPOT else sizes[chosen]
            found.append(Piece(poses, kind, np.append(0.0, np.cumsum(size))))
            begin = n
    return found


@dataclass(frozen=True)
class PurePursuitSettings:
    """m, s, rad. `turn_in_place` is for robots that can; a car's path has no turns on the spot."""

    desired_linear_vel: float
    acc_lim_x: float
    acc_lim_theta: float
    max_vel_theta: float
    min_vel_theta: float
    minimum_turning_radius: float
    turn_in_place: bool
    lookahead_time: float
    min_lookahead_dist: float
    max_lookahead_dist: float
    use_regulated_linear_velocity_scaling: bool
    regulated_linear_scaling_min_radius: float
    regulated_linear_scaling_min_speed: float
    use_cost_regulated_linear_velocity_scaling: bool
    cost_scaling_dist: float
    cost_scaling_gain: float
    approach_velocity_scaling_dist: float
    min_approach_linear_velocity: float
    max_allowed_time_to_collision_up_to_carrot: float
    max_deviation: float
    xy_goal_tolerance: float
    yaw_goal_tolerance: float
    trans_stopped_vel: float
    controller_frequency: float


class PurePursuit:
    """Follows one path, piece by piece; `set_path` begins a new one."""

    def __init__(self, settings: PurePursuitSettings) -> None:
        self.settings = settings
        self.pieces: list[Piece] = []
        self.goal: np.ndarray | None = None

    def set_path(self, path: np.ndarray, again: bool = False) -> None:
        """Path (N, 3) with the heading at each pose, in a fixed frame. ValueError if invalid.

        `again`: the goal is the same as before; that makes no difference here.
        """
        path = np.array(path, float)
        if path.ndim != 2 or path.shape[1:] != (3,) or not len(path) or not np.isfinite(path).all():
            raise ValueError(f"a path is (N, 3), finite and not empty, not {path.shape}")
        self.pieces, self.goal = cut(path), path[-1]
        self._begin_piece()

    def _begin_piece(self) -> None:
        self.at = 0
        self.steering_left = round(STEERING_TIME * self.settings.controller_frequency)

    def reached(self, pose: np.ndarray, velocity: np.ndarray,
                path_frame: np.ndarray = STANDSTILL) -> bool:
        """Whether the vehicle stands at the goal, on the last piece; arguments as in `command`."""
        if self.goal is None or len(self.pieces) > 1:
            return False
        return (self._there(pose, compose(path_frame, self.goal))
                and abs(velocity[0]) <= self.settings.trans_stopped_vel)

    def _there(self, pose: np.ndarray, goal: np.ndarray, share: float = 1.0) -> bool:
        """Whether a pose is at the goal, within a `share` of the tolerance of position."""
        s = self.settings
        return bool(np.hypot(*(goal[:2] - pose[:2])) <= share * s.xy_goal_tolerance
                    and abs(wrap_angle(goal[2] - pose[2])) <= s.yaw_goal_tolerance)

    def command(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
                velocity: np.ndarray, path_frame: np.ndarray = STANDSTILL) -> Command | None:
        """The next velocity, within `limits`; None if the way is blocked, the vehicle has left its
        path, or `velocity` is not finite.

        `pose` (3,) in the costmap's frame; `velocity` (3,) in the base frame; `footprint` (K, 2);
        `path_frame`: pose of the path's frame in the costmap's.
        """
        if self.goal is None:
            return None
        pose, velocity = np.array(pose, float), np.array(velocity, float)
        if not np.isfinite(velocity).all():
            return None
        standing = Command(0.0, 0.0, 0.0, pose[None])
        goal = compose(np.asarray(path_frame, float), self.goal)
        footprint = footprints.shrunk_to_fit(costmap, np.asarray(footprint, float), pose)
        if footprint is None:
            return None
        while self.pieces:
            piece = self.pieces[0]
            poses = compose(np.asarray(path_frame, float), piece.poses)
            if piece.direction == ON_THE_SPOT:
                angle = wrap_angle(poses[-1, 2] - pose[2])
                if abs(angle) > 0.5 * self.settings.yaw_goal_tolerance:
                    return self._turn(costmap, footprint, pose, velocity, angle)
                left = 0.0
            else:
                left = self._left(piece, poses, pose)
                if left > DONE and not (len(self.pieces) == 1 and self._there(pose, goal, 0.4)):
                    command = self._drive(costmap, footprint, pose, velocity, piece, poses, left)
                    if command is not None or left > ENOUGH or len(self.pieces) == 1:
                        return command
            if abs(velocity[0]) > self.settings.trans_stopped_vel:
                return standing
            if len(self.pieces) == 1:
                break
            self.pieces.pop(0)
            self._begin_piece()
        return standing if self._there(pose, goal) else None

    def limits(self) -> Limits:
        """Limits that are never exceeded."""
        s = self.settings
        fastest = max(s.desired_linear_vel, s.min_approach_linear_velocity), 0.0, s.max_vel_theta
        return Limits(tuple(-most for most in fastest), fastest)

    def _left(self, piece: Piece, poses: np.ndarray, pose: np.ndarray) -> float:
        """The rest of a piece, m; the position on it, `at`, never goes back."""
        lengths = piece.lengths
        near = np.nonzero(lengths[self.at:] <= lengths[self.at] + AHEAD)[0]
        self.at += int(np.hypot(*(poses[self.at + near, :2] - pose[:2]).T).argmin())
        x, y, yaw = poses[-1]
        to_end = piece.direction * ((x - pose[0]) * np.cos(yaw) + (y - pose[1]) * np.sin(yaw))
        left = lengths[-1] - lengths[self.at]
        return float(to_end if left < self.settings.min_lookahead_dist else left)

    def _turn(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
              velocity: np.ndarray, angle: float) -> Command | None:
        """Turn on the spot towards the end of the piece."""
        s = self.settings
        if not s.turn_in_place:
            return None
        if abs(velocity[0]) > s.trans_stopped_vel:
            return Command(0.0, 0.0, 0.0, pose[None])
        poses = turned(pose, angle)
        if (footprints.costs(costmap, footprint, poses) < 0).any():
            return None
        omega = turning(angle, velocity[2], s.min_vel_theta, s.max_vel_theta, s.acc_lim_theta,
                        1.0 / s.controller_frequency)
        return Command(0.0, 0.0, omega, poses)

    def _drive(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
               velocity: np.ndarray, piece: Piece, poses: np.ndarray, left: float
               ) -> Command | None:
        """Drive along an arc to the carrot, or the nearest to it that is free."""
        s = self.settings
        if np.hypot(*(poses[self.at, :2] - pose[:2])) > s.max_deviation:
            return None
        speed = abs(velocity[0])
        reach = float(np.clip(speed * s.lookahead_time, s.min_lookahead_dist,
                              s.max_lookahead_dist))
        carrot = self._carrot(piece, poses, reach)
        offset = relative(pose, carrot)
        limit = 1.0 / s.minimum_turning_radius
        wanted = float(np.clip(2 * offset[1] / max(offset[0] ** 2 + offset[1] ** 2, 1e-6),
                               -limit, limit))
        most = self._speed(costmap, footprint, pose, wanted, left)
        # The arc must be free up to the carrot, or over the time to collision, or the braking way.
        ahead = min(reach, most * s.max_allowed_time_to_collision_up_to_carrot)
        ahead = max(ahead, speed ** 2 / (2 * s.acc_lim_x) + costmap.resolution)
        ahead = min(ahead, max(left, costmap.resolution))
        chosen = free_arc(costmap, footprint, pose, piece.direction * ahead, wanted, limit, carrot)
        if chosen is None:
            return None
        curvature, arc = chosen
        return self._paced(velocity, piece.direction * most, curvature, arc)

    def _paced(self, velocity: np.ndarray, wanted: float, curvature: float, arc: np.ndarray
               ) -> Command:
        """Approach the wanted speed, within the limits."""
        s = self.settings
        if not self._is_steered(velocity, curvature):
            wanted = float(np.sign(wanted)) * s.min_approach_linear_velocity
        step = s.acc_lim_x / s.controller_frequency
        vx = float(np.clip(wanted, velocity[0] - step, velocity[0] + step))
        vx = float(np.clip(vx, self.limits().low[0], self.limits().high[0]))
        if 0.0 < vx * np.sign(wanted) < s.min_approach_linear_velocity:
            vx = float(np.sign(wanted)) * s.min_approach_linear_velocity
        if abs(vx * curvature) > s.max_vel_theta:
            vx = float(np.sign(vx)) * s.max_vel_theta / abs(curvature)
        return Command(vx, 0.0, vx * curvature, arc)

    def _is_steered(self, velocity: np.ndarray, curvature: float) -> bool:
        """Whether it may speed up: the front wheels of a car take a while to steer."""
        s = self.settings
        speed = abs(velocity[0])
        if speed > 2 * s.min_approach_linear_velocity or self.steering_left <= 0:
            return True
        self.steering_left -= 1
        moves = speed > 0.5 * s.min_approach_linear_velocity
        turned = velocity[2] / velocity[0] if moves else 0.0  # unknown while it stands
        return bool(abs(turned - curvature) <= STEERED / s.minimum_turning_radius)

    def _carrot(self, piece: Piece, poses: np.ndarray, reach: float) -> np.ndarray:
        """The pose (3,) that is pursued: `reach` along the piece, or straight on after its end."""
        target = piece.lengths[self.at] + reach
        if target <= piece.lengths[-1]:
            return poses[int(np.searchsorted(piece.lengths, target))]
        beyond = piece.direction * (target - piece.lengths[-1])
        return compose(poses[-1], (beyond, 0.0, 0.0))

    def _speed(self, costmap: Costmap, footprint: np.ndarray, pose: np.ndarray, curvature: float,
               left: float) -> float:
        """The speed, m/s, above 0: slower in curves, near obstacles and before the end."""
        s = self.settings
        speed = s.desired_linear_vel
        if s.use_regulated_linear_velocity_scaling and curvature:
            radius = 1.0 / abs(curvature)
            speed *= min(radius / s.regulated_linear_scaling_min_radius, 1.0)
        if s.use_cost_regulated_linear_velocity_scaling:
            room = space(costmap, footprint, pose)
            if room < s.cost_scaling_dist:
                speed *= min(s.cost_scaling_gain * room / s.cost_scaling_dist, 1.0)
        speed = max(speed, min(s.regulated_linear_scaling_min_speed, s.desired_linear_vel))
        speed *= min(left / s.approach_velocity_scaling_dist, 1.0)
        speed = min(speed, np.sqrt(2 * 0.5 * s.acc_lim_x * max(left, 0.0)))
        return max(float(speed), s.min_approach_linear_velocity)

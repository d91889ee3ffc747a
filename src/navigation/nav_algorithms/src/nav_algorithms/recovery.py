"""Recovery behaviours: look round, or leave a tight spot; one command per call."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.free_arcs import arc_of
from nav_algorithms.local_planning.goal import turned
from nav_algorithms.local_planning.velocities import Command


@dataclass(frozen=True)
class RotateSettings:
    """Parameters of rotate_recovery/RotateRecovery; rad, s."""

    sim_granularity: float
    frequency: float
    acc_lim_theta: float
    max_vel_theta: float
    min_in_place_vel_theta: float
    yaw_goal_tolerance: float


@dataclass(frozen=True)
class EscapeSettings:
    """Parameters of leaving a tight spot; m, s. A radius of 0: the robot only drives straight."""

    distance: float
    speed: float
    minimum_turning_radius: float


def rotation(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray, turned_so_far: float,
             settings: RotateSettings) -> Command | None:
    """The next command of one full turn to the left, of which `turned_so_far`, rad, is done.

    Zero once it is done; None if the footprint (K, 2) would touch something during the rest.
    `pose` (3,) in the costmap's frame.
    """
    left = 2 * np.pi - turned_so_far
    pose = np.asarray(pose, float)
    if left <= settings.yaw_goal_tolerance:
        return Command(0.0, 0.0, 0.0, pose[None])
    footprint = footprints.shrunk_to_fit(costmap, np.asarray(footprint, float), pose)
    if footprint is None:
        return None
    poses = turned(pose, left, settings.sim_granularity)
    if (footprints.costs(costmap, footprint, poses) < 0).any():
        return None
    omega = float(np.clip(np.sqrt(2 * settings.acc_lim_theta * left),
                          settings.min_in_place_vel_theta, settings.max_vel_theta))
    return Command(0.0, 0.0, omega, poses)


def escape(costmap: Costmap, footprint: np.ndarray, pose: np.ndarray,
           settings: EscapeSettings) -> Command | None:
    """A slow drive out of a tight spot, backwards or forwards; None if all ways are blocked.

    Of the free ways over `distance`, or over half of it if there is none, the one that ends
    farthest from all obstacles. Among equals backwards comes first: the robot came from there. The
    command holds for the length of its trajectory. Within a cell of something smaller footprints
    are tried, too, for ways that end no nearer to it.
    """
    pose = np.asarray(pose, float)
    bends = [0.0]
    if settings.minimum_turning_radius > 0.0:
        bends += [1.0 / settings.minimum_turning_radius, -1.0 / settings.minimum_turning_radius]
    arcs = [(sign, bend, arc_of(pose, sign * distance, bend, 0.5 * costmap.resolution))
            for distance in (settings.distance, 0.5 * settings.distance)
            for sign in (-1.0, 1.0) for bend in bends]
    both = len(arcs) // 2
    radii = footprints.free_radii(costmap)
    least = 0.0
    for outline in footprints.to_leave_with(costmap, np.asarray(footprint, float), pose):
        for some in (arcs[:both], arcs[both:]):
            best = _roomiest(costmap, radii, outline, some, least)
            if best is not None:
                sign, bend, arc = best
                speed = sign * settings.speed
                return Command(speed, 0.0, speed * bend, arc)
        least = radii[tuple(costmap.cells_of(pose[:2]))]  # with less of itself: no nearer
    return None


def _roomiest(costmap: Costmap, radii: np.ndarray, outline: np.ndarray,
              arcs: list[tuple[float, float, np.ndarray]], least: float
              ) -> tuple[float, float, np.ndarray] | None:
    """Of the arcs (sign, bend, poses) that are free, the one that ends farthest from obstacles, and
    no nearer than `least`, in cells."""
    best, widest = None, 0.0
    for found in arcs:
        arc = found[2]
        if (footprints.costs(costmap, outline, arc) < 0).any():
            continue
        space = radii[tuple(costmap.cells_of(arc[-1, :2]))]
        if space >= least and space > widest + 1e-9:
            best, widest = found, space
    return best

"""A waffle that touches something drives away, though its costmap says that all it does collides.

The laser's costmap has cells of 5 cm, and those below the robot are free: beside a wall the robot
fits where it stands, and nowhere else. What it really touches stops it.
"""

from __future__ import annotations

import numpy as np
import pytest
from defaults import of

from nav_algorithms import rays, recovery
from nav_algorithms.cells import OccupancyGrid
from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.costmap.costs import LETHAL, Costmap
from nav_algorithms.costmap.inflation import InflationLayer
from nav_algorithms.costmap.layered import LayeredCostmap
from nav_algorithms.costmap.obstacles import Observation, ObstacleLayer
from nav_algorithms.costmap.static import StaticLayer
from nav_algorithms.global_planning import navfn
from nav_algorithms.local_planning.dwa import DwaPlanner, DwaSettings
from nav_algorithms.local_planning.trajectory_rollout import (
    TrajectoryRollout,
    TrajectoryRolloutSettings,
)
from nav_algorithms.poses import compose

OUTLINE = footprints.padded(np.array([[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155],
                                      [0.077, -0.155]]), 0.01)
BODY = footprints.padded(OUTLINE, -0.022)
FINE, CELL, PERIOD, TICK = 0.01, 0.05, 0.1, 0.02  # m, m, s, s
LASER, ANGLES = np.array([-0.064, 0.0, 0.0]), np.arange(360) * 2 * np.pi / 360
ACCELERATION = np.array([2.5, 0.0, 3.2])
NEARER, PATIENCE, LIMIT = 0.2, 100, 600  # m within so many periods, else it is stuck; all of them


def dwa():
    return DwaPlanner(of(DwaSettings,
        max_vel_x=0.26, min_vel_x=-0.26, max_vel_trans=0.26, min_vel_trans=0.13, max_vel_y=0.0,
        min_vel_y=0.0, acc_lim_y=0.0, max_vel_theta=1.82, min_vel_theta=0.9, sim_time=2.0,
        vx_samples=20, vy_samples=0, vth_samples=40, path_distance_bias=32.0,
        goal_distance_bias=20.0, occdist_scale=0.02, controller_frequency=10.0,
        xy_goal_tolerance=0.05, yaw_goal_tolerance=0.17))


def rollout():
    return TrajectoryRollout(of(TrajectoryRolloutSettings,
        max_vel_x=0.26, min_vel_x=0.05, max_vel_theta=1.8, min_vel_theta=-1.8,
        holonomic_robot=False, controller_frequency=10.0, vx_samples=6, yaw_goal_tolerance=0.1,
        trans_stopped_velocity=0.05, rot_stopped_velocity=0.1))


def yard(what):
    """Occupied fine cells of 4 m x 4 m, with something in the middle."""
    occupied = np.pad(np.zeros((390, 390), np.uint8), 5, constant_values=1)
    if what in ("wall", "corner"):
        occupied[:, 200:210] = 1
    if what == "corner":
        occupied[200:210, :210] = 1
    if what == "box":
        occupied[180:220, 180:220] = 1
    if what == "post":
        y, x = np.mgrid[:400, :400] - 200
        occupied[x * x + y * y <= 144] = 1
    return occupied


class Waffle:
    """What stands in the yard, and what move_base knows of it."""

    def __init__(self, what, pose, planner):
        self._occupied = yard(what)
        self._truth = Costmap(self._occupied * np.uint8(LETHAL), FINE, (0, 0))
        self.pose, self._velocity, self._planner = np.array(pose), np.zeros(3), planner
        walls = self._occupied.reshape(80, 5, 80, 5).max(axis=(1, 3))
        known = StaticLayer("map")
        self._fixed = LayeredCostmap([known, ObstacleLayer("laser"), InflationLayer("i", 1.0, 3.0)],
                                     (80, 80), CELL, (0, 0))
        known.set_map(OccupancyGrid((walls * 100).astype(np.int8), CELL, (0.0, 0.0)),
                      walls * np.uint8(LETHAL))
        self._local = LayeredCostmap([ObstacleLayer("laser"), InflationLayer("i", 1.0, 3.0)],
                                     (60, 60), CELL, (0, 0), rolling=True)
        for costmap in (self._fixed, self._local):
            costmap.set_footprint(OUTLINE)

    def goes_to(self, goal):
        """Whether it is there before it is stuck, or time is over."""
        path, places, commandless = None, [], 0
        for period in range(LIMIT):
            self._look()
            if period % 2 == 0:
                found = navfn.plan(self._fixed.newest, self.pose, goal,
                                   settings=of(navfn.NavfnSettings))
                if found is not None:
                    self._planner.set_path(found, again=path is not None)
                    path = found
            assert path is not None
            if self._planner.reached(self.pose, self._velocity):
                return True
            command = self._planner.command(self._local.newest, OUTLINE, self.pose, self._velocity)
            commandless = commandless + 1 if command is None else 0
            self._obey(np.zeros(3) if command is None else command.velocity)
            places.append(self.pose[:2])
            away = np.hypot(*(np.array(places[-PATIENCE:]) - self.pose[:2]).T)
            if commandless > PATIENCE or (len(places) > PATIENCE and away.max() < NEARER):
                return False
        return False

    def escapes(self):
        """Recovers as EscapeRecovery does."""
        command = recovery.escape(self._local.newest, OUTLINE, self.pose,
                                  of(recovery.EscapeSettings))
        way = command.trajectory
        for _ in range(PATIENCE):
            self._obey(command.velocity)
            if np.hypot(*(way[:, :2] - self.pose[:2]).T).argmin() == len(way) - 1:
                break
        self._look()

    def _look(self):
        x, y, yaw = compose(self.pose, LASER)
        ranges = rays.cast(self._occupied, FINE, 0.0, 0.0, x, y, ANGLES + yaw, 3.5)
        ends = np.stack([x + ranges * np.cos(ANGLES + yaw), y + ranges * np.sin(ANGLES + yaw),
                         np.full(360, 0.2)], axis=1)[(ranges > 0.12) & (ranges < 3.5)]
        seen = [Observation(np.array([x, y, 0.2]), ends, 3.0, 3.5)]
        for costmap in (self._fixed, self._local):
            for layer in costmap.layers:
                if layer.from_sensors:
                    layer.observe(seen, seen)
            costmap.update(self.pose)

    def _obey(self, wanted):
        for _ in range(round(PERIOD / TICK)):
            step = ACCELERATION * TICK
            self._velocity = self._velocity + np.clip(wanted - self._velocity, -step, step)
            x, y, turn = self._velocity * TICK
            moves = compose(self.pose, np.array([[x, y, turn], [x, y, 0.0], [0.0, 0.0, turn]]))
            free = np.flatnonzero(footprints.costs(self._truth, BODY, moves) >= 0)
            if not len(free):
                self._velocity = np.zeros(3)
                return
            self.pose = moves[free[0]]


@pytest.mark.parametrize("planner, what, pose, goal", [
    (dwa, "wall", (1.823, 1.688, -1.717), (0.7, 1.0, 0.0)),
    (dwa, "corner", (1.835, 1.537, 1.651), (0.7, 1.0, 0.0)),
    (rollout, "post", (2.211, 2.186, 2.353), (3.3, 3.2, 0.0)),
    (rollout, "box", (2.301, 1.742, 1.701), (3.3, 1.0, 0.0)),
    (rollout, "box", (1.845, 1.640, -0.228), (0.7, 1.0, 0.0))])
def test_what_presses_against_something_goes_on_after_escaping(planner, what, pose, goal):
    """To the planner it touches with whatever it does, as to upstream's: every goal is given up."""
    waffle = Waffle(what, pose, planner())
    assert not waffle.goes_to(np.array(goal))
    waffle.escapes()
    assert waffle.goes_to(np.array(goal))


def beside(gap):
    """A wall that far from the right side of a waffle at the origin, m; its costmap."""
    cells = np.zeros((60, 60), np.uint8)
    costmap = Costmap(cells, CELL, (-1.5, -1.5))
    cells[:costmap.cells_of((0.0, OUTLINE[:, 1].min() - gap - 1e-6))[0] + 1] = LETHAL
    return costmap


def sizes(costmap):
    return [round(outline[0, 0] / OUTLINE[0, 0], 2) for outline in footprints.to_leave_with(
        costmap, OUTLINE, np.zeros(3))]


def test_smaller_outlines_are_tried_only_beside_something():
    assert sizes(beside(0.2)) == [1.0]
    assert sizes(beside(0.04)) == [1.0, 0.9, 0.8, 0.7, 0.6]
    assert sizes(beside(-0.015)) == [0.9, 0.8, 0.7, 0.6]
    assert sizes(beside(-0.065)) == [0.6]
    assert sizes(beside(-0.115)) == []


def test_a_round_robot_has_one_size():
    assert len(list(footprints.to_leave_with(beside(0.04), np.zeros((0, 2)), np.zeros(3)))) == 1

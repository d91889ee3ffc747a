"""Watches one drive, sample by sample: how far, how close, and whether anything was touched."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from run_session.simulator import Place
from trial_worlds.clearance import CONTACT, clearance
from trial_worlds.crossing import PERSON_RADIUS

STANDING = 0.02   # m/s
PATH_STEP = 0.02  # m between two points that are kept
OBSTACLE, PERSON, WALKED_INTO = (
    "touched an obstacle", "touched the person", "the person walked into the standing robot")


@dataclass(frozen=True)
class Sample:
    """Where robot and person were, by the simulator's own word."""

    time: float  # s, simulated
    robot: Place
    speed: float  # m/s, of the robot
    person: Place | None


class Judge:
    """Of one drive from its first sample on; after a contact nothing more counts."""

    def __init__(self, cylinders: np.ndarray, radius: float):
        """`cylinders` (N, 2): centres, m, of circles of that radius; none in an empty room."""
        self._cylinders, self._radius = cylinders, radius
        self._began: float | None = None
        self._last: Sample | None = None
        self.time = self.distance = 0.0  # s, m
        self.to_obstacles = self.to_person = math.inf  # m of air, the least so far
        self.contact: str | None = None
        self.path: list[tuple[float, ...]] = []  # s, x, y, yaw, where it had gone on

    def see(self, sample: Sample) -> None:
        """The next one."""
        if self.contact:
            return
        self._began = sample.time if self._began is None else self._began
        self.time = sample.time - self._began
        if self._last is not None:
            self.distance += math.dist(self._last.robot[:2], sample.robot[:2])
        self._last = sample
        if not self.path or math.dist(self.path[-1][1:3], sample.robot[:2]) >= PATH_STEP:
            self.path.append((self.time, *sample.robot))
        self._look(sample)

    def off(self, place: Place) -> float:
        """m that the robot was from a place at last; inf before the first sample."""
        return math.inf if self._last is None else math.dist(self._last.robot[:2], place[:2])

    def _look(self, sample: Sample) -> None:
        air = clearance(sample.robot, self._cylinders, self._radius)
        self.to_obstacles = min(self.to_obstacles, air)
        if air < CONTACT:
            self.contact = OBSTACLE
        if sample.person is None:
            return
        air = clearance(sample.robot, np.array([sample.person[:2]]), PERSON_RADIUS)
        self.to_person = min(self.to_person, air)
        if air < CONTACT:
            self.contact = WALKED_INTO if sample.speed < STANDING else PERSON

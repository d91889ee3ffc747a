"""Judges one drive, sample by sample: distances, gaps and contacts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from run_session.simulator import Place
from trial_worlds.clearance import CONTACT, clearance
from trial_worlds.crossing import PERSON_RADIUS

STANDING = 0.02   # m/s
PATH_STEP = 0.02  # m between two recorded points
OBSTACLE, PERSON, WALKED_INTO = (
    "touched an obstacle", "touched the person", "the person walked into the standing robot")


@dataclass(frozen=True)
class Sample:
    """Positions of robot and person, by the simulator."""

    time: float  # s, simulated
    robot: Place
    speed: float  # m/s, of the robot
    person: Place | None


class Judge:
    """Judges one drive from its first sample on; after a contact nothing more counts."""

    def __init__(self, cylinders: np.ndarray, radius: float):
        """`cylinders` (N, 2): centres, m, of circles of that radius; none in an empty room."""
        self._cylinders, self._radius = cylinders, radius
        self._began: float | None = None
        self._last: Sample | None = None
        self.time = self.distance = 0.0  # s, m
        self.to_obstacles = self.to_person = math.inf  # least gaps so far, m
        self.contact: str | None = None
        self.path: list[tuple[float, ...]] = []  # s, x, y, yaw, every PATH_STEP

    def see(self, sample: Sample) -> None:
        """Take the next sample."""
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
        """The robot's last distance from a place, m; inf before the first sample."""
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

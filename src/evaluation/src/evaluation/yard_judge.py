"""Judges one drive, sample by sample: distances, gaps and contacts; and the drives' results."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from evaluation.report import cell, grouped, mean
from run_session.simulator import Place
from trial_worlds.crossing import CONTACT, PERSON_RADIUS, clearance

STANDING = 0.02   # m/s
PATH_STEP = 0.02  # m between two recorded points
OBSTACLE, PERSON, WALKED_INTO_ROBOT = (
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
            self.contact = WALKED_INTO_ROBOT if sample.speed < STANDING else PERSON


YARDS, CROSSINGS = "yards", "crossings"  # the two sets of drives
REACHED, TOUCHED, WALKED_INTO, GIVEN_UP, LATE, NOT_THERE = (
    "reached", "contact", "walked into", "given up", "late", "called reached")
LEAST_SHARE = 0.95  # of the yards, and of the crossings except those that people ended
BEST, WORST = 4.0, 8.0  # multiples of the shortest time between which BARN's score falls


@dataclass(frozen=True)
class DriveResult:
    """The result of one drive; m, s."""

    set: str
    seed: int
    repeat: int
    outcome: str
    why: str | None
    time: float
    distance: float
    straight_time: float  # of the straight line from start to goal at top speed
    shortest_time: float  # of the shortest path that is wide enough, at top speed
    to_obstacles: float | None  # the least gap; None: there were none
    to_person: float | None
    recoveries: list[str]
    slow_cycles: int  # move_base's warnings that it was too slow, at most one in 5 s
    real_time_factor: float
    drawn: dict = field(default_factory=dict)  # the yard's difficulty, or the person's walk

    @property
    def reached(self) -> bool:
        """Whether it reached its goal without touching anything."""
        return self.outcome == REACHED

    @property
    def score(self) -> float:
        """The BARN challenge's: 0.25 for a fast drive, 0.125 for a slow one, 0 for none."""
        if not self.reached:
            return 0.0
        return self.shortest_time / min(max(self.time, BEST * self.shortest_time),
                                        WORST * self.shortest_time)

    @property
    def name(self) -> str:
        """Its case's name, also that of its files."""
        return f"{self.set}-{self.seed}-{self.repeat}"

    @property
    def line(self) -> str:
        """A one-line summary."""
        why = f" ({self.why})" if self.why else ""
        air = self.to_obstacles if self.to_person is None else self.to_person
        recovered = f", {len(self.recoveries)} recoveries" if self.recoveries else ""
        return (f"{self.name}: {self.outcome}{why}, {self.time:.1f} s (straight"
                f" {self.straight_time:.1f} s), {cell(air, 100, 1)} cm of air{recovered},"
                f" real time x{self.real_time_factor:.2f}")


COLUMNS = {
    "drives": lambda each: each["set"],
    "reached": lambda each: f"{each['outcomes'].get(REACHED, 0)} of {each['drives']}",
    "": lambda each: f"{each['share_reached']:.0%}",
    "s": lambda each: cell(each["mean_time"]),
    "straight s": lambda each: cell(each["mean_straight_time"]),
    "ratio": lambda each: cell(each["mean_time_by_straight"], 1, 2),
    "BARN": lambda each: cell(each["mean_score"], 1, 3),
    "air cm": lambda each: cell(each["least_to_obstacles"], 100),
    "to person cm": lambda each: cell(each["least_to_person"], 100),
    "with recovery": lambda each: str(each["drives_with_recovery"])}


def summarize(drives: Sequence[DriveResult]) -> list[dict]:
    """A summary for each set; means are of drives that reached the goal, None if none did."""
    return [_summary(*group) for group in grouped(drives, lambda drive: drive.set).items()]


def _summary(name: str, drives: list[DriveResult]) -> dict:
    there = [drive for drive in drives if drive.reached]
    return {
        "set": name, "drives": len(drives),
        "outcomes": dict(Counter(sorted(drive.outcome for drive in drives))),
        "share_reached": len(there) / len(drives),
        "mean_time": mean([drive.time for drive in there]),
        "mean_straight_time": mean([drive.straight_time for drive in there]),
        "mean_time_by_straight": mean([drive.time / drive.straight_time for drive in there]),
        "mean_time_by_shortest": mean([drive.time / drive.shortest_time for drive in there]),
        "mean_score": mean([drive.score for drive in drives]),
        "least_to_obstacles": min(
            (d.to_obstacles for d in there if d.to_obstacles is not None), default=None),
        "least_to_person": min(
            (d.to_person for d in there if d.to_person is not None), default=None),
        "drives_with_recovery": sum(bool(drive.recoveries) for drive in drives),
        "failed": [drive.name for drive in drives if not drive.reached]}

"""The figures of a run, and whether they are within the limits."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from evaluation.house.records import Contact, Records
from evaluation.navigation.driver import Way
from nav_algorithms.grid import FREE, UNKNOWN, OccupancyGrid
from nav_algorithms.map_agreement import MapAgreement, map_agreement
from nav_algorithms.trajectory_error import TrajectoryError, trajectory_error
from run_session.failure import RunError
from trial_worlds.ground import Ground
from trial_worlds.true_map import visible_walls

MOST_ATE = 0.05  # m
LEAST_AGREEMENT = 0.95  # share
MOST_OFF, MOST_OFF_DEG = 0.05, 2.0  # m and degrees, mean error of localisation
MOST_MISS, MOST_MISS_DEG = 0.2, 20.0  # m and degrees from a goal that is reported reached
MOST_UNSEEN = 1.0  # s, simulated, between two contact checks, in which it may drive 26 cm
POSE_STEP = 10  # every tenth pose is checked for what the laser saw from there


@dataclass(frozen=True)
class Pace:
    """How long a part of the run took, and what its processes used."""

    simulated: float  # s
    wall: float  # s
    cpu: dict[str, float]  # percent of one core, by node; in s used in 100 simulated s

    @property
    def factor(self) -> float:
        """Simulated over wall time."""
        return self.simulated / self.wall if self.wall > 0 else 0.0


@dataclass(frozen=True, kw_only=True)
class Leg:
    """The figures of one part of the run."""

    name: ClassVar[str]  # in words
    way: ClassVar[str]  # what one of its drives leads to

    ways: list[Way]
    contacts: list[Contact]
    nearest: float  # m, smallest gap to anything
    unseen: float  # s, simulated: longest time between two contact checks
    driven: float  # m
    pace: Pace

    def common_faults(self) -> list[str]:
        """Violated limits that both parts have, in words."""
        found = []
        for number, way in enumerate(self.ways, start=1):
            name = f"{self.way} {number} ({way.goal[0]:.2f}, {way.goal[1]:.2f})"
            off_deg = np.degrees(way.off_yaw)
            if not way.reached:
                found.append(f"{name} not reached: {way.text}")
            elif way.off > MOST_MISS or off_deg > MOST_MISS_DEG:
                found.append(f"{name} called reached, but {_cm(way.off)} and {off_deg:.0f}° off")
        found += [f"{self.name}: {each.own} touched something at {each.begin:.1f} s, {each.place}"
                  for each in self.contacts]
        if self.unseen > MOST_UNSEEN:
            found.append(f"{self.name}: nobody looked for {self.unseen:.1f} s whether it touches"
                         f" something, more than {MOST_UNSEEN:g} s: this machine is too busy")
        return found


def seen_of(records: Records) -> dict:
    """The fields of a part that come from its records."""
    return dict(contacts=records.contacts, nearest=records.nearest[0],
                unseen=float(records.longest_unseen), driven=records.length)


@dataclass(frozen=True, kw_only=True)
class Mapping(Leg):
    """The mapping part."""

    name, way = "mapping", "way-point"

    trajectory: TrajectoryError
    agreement: MapAgreement
    known: float  # m^2, free

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        found = []
        if self.trajectory.ate_rmse > MOST_ATE:
            found.append(f"mapping: trajectory error {_cm(self.trajectory.ate_rmse)}, "
                         f"more than {_cm(MOST_ATE)}")
        for what, share in (("occupied cells near true walls", self.agreement.occupied_near_walls),
                            ("seen walls on the map", self.agreement.walls_found)):
            if share < LEAST_AGREEMENT:
                found.append(f"mapping: {what} {share:.1%}, less than {LEAST_AGREEMENT:.0%}")
        return found + self.common_faults()


@dataclass(frozen=True)
class Localisation:
    """Errors of the estimated pose; m and rad."""

    told: tuple[float, float] | None  # of the initial pose that was given
    found: tuple[float, float]  # after the turn on the spot
    mean: tuple[float, float]  # on the way to the goals
    largest: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Navigation(Leg):
    """The part with the goals."""

    name, way = "on the way to the goals", "goal"

    localisation: Localisation

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        off, off_deg = self.localisation.mean[0], np.degrees(self.localisation.mean[1])
        if off <= MOST_OFF and off_deg <= MOST_OFF_DEG:
            return self.common_faults()
        return [f"localisation: {_cm(off)} and {off_deg:.1f}° off in the mean, more than "
                f"{_cm(MOST_OFF)} and {MOST_OFF_DEG:g}°", *self.common_faults()]


@dataclass
class Result:
    """The results of a run, or of as much as was run before it ended."""

    map: OccupancyGrid | None = None
    map_in_world: np.ndarray = field(default_factory=lambda: np.zeros(3))
    mapping: Mapping | None = None
    navigation: Navigation | None = None
    paths: dict[str, np.ndarray] = field(default_factory=dict)  # (N, 2) m, by the run's part

    @property
    def faults(self) -> list[str]:
        """Violated limits, in words."""
        return [fault for part in (self.mapping, self.navigation) if part for fault in part.faults]


def score_mapping(ground: Ground, built: OccupancyGrid, records: Records, angles: np.ndarray,
                  reach: float, ways: list[Way], pace: Pace) -> Mapping:
    """Compare the map with the walls that a laser with these beams (rad) and reach (m) could see.

    Raises RunError if there are no true and estimated poses of the same times.
    """
    _, believed, true = records.moments()
    if not len(true):
        raise RunError("mapping: the true pose was seen too seldom to judge the map by: this "
                       "machine is too busy; PACE=0.5 may help")
    trajectory = trajectory_error(believed, true)
    seen = visible_walls(ground.walls, true[::POSE_STEP], angles, reach)
    agreement = map_agreement(built, ground.walls, seen, trajectory.alignment)
    free = (built.cells >= FREE) & (built.cells < 50) & (built.cells != UNKNOWN)
    return Mapping(**seen_of(records), ways=ways, pace=pace, trajectory=trajectory,
                   agreement=agreement, known=float(free.sum() * built.resolution ** 2))


def localisation(told: tuple[float, float] | None, errors: np.ndarray) -> Localisation:
    """From errors (N, 2) on the way to the goals; the first one follows the turn on the spot."""
    if not len(errors):
        errors = np.full((1, 2), np.inf)
    return Localisation(told, tuple(errors[0].tolist()), tuple(errors.mean(axis=0).tolist()),
                        tuple(errors.max(axis=0).tolist()))


def _cm(length: float) -> str:
    return f"{length * 100:.1f} cm"
